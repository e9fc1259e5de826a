#include "wearwell/prognosis/unit_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/heading.h"

namespace wearwell::prognosis {

const Column* optional_column(const Table& table, std::string_view name) {
  for (const Column& each : table.columns)
    if (each.name == name) return &each;
  return nullptr;
}

void refuse_other_columns(const Table& table, std::initializer_list<const Column*> known,
                          const char* names) {
  for (const Column& each : table.columns) {
    if (std::find(known.begin(), known.end(), &each) == known.end())
      throw InputError(fmt::format("{}: column '{}' is unknown; columns are {}", table.source,
                                   printable(each.name), names));
  }
}

std::string cell_text(const Column* column, std::size_t row) {
  if (!column) return "";
  if (!column->is_number) return column->text[row];
  return std::isnan(column->numbers[row]) ? "" : fmt::format("{}", column->numbers[row]);
}

std::string heading_unit(const Column& column) {
  const std::string unit = read_heading(column.name, "").unit;
  return unit.empty() ? bare_unit(column.unit) : unit;
}

}  // namespace wearwell::prognosis
