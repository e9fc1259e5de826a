#include "wearwell/study/data_in_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"

namespace wearwell {
namespace {

std::string unit_name(const DataColumn& column) {
  return column.unit.text == "1" ? column.si : column.unit.text;
}

/// "1 mm^3 = 10^-9 m^3"; for a temperature its zero, "0 degC = 273.15 K"; empty for SI units and
/// for plain numbers.
std::string one_unit(const DataColumn& column) {
  const std::string unit = unit_name(column);
  if (column.unit.offset != 0)
    return fmt::format("0 {} = {} {}", unit, plain_given(column.unit.offset), column.si);
  if (unit == column.si || (column.unit.scale == 1 && unit == column.si + "s")) return "-";
  // "1000 = 1000 rev", if the unit is itself a number.
  const bool is_number = unit.front() >= '0' && unit.front() <= '9';
  const std::string one = is_number ? numbers_text(unit, Script::terminal) : "1 " + unit;
  return fmt::format("{} = {}{}", one, plain_given(column.unit.scale),
                     column.si == "1" ? "" : " " + column.si);
}

/// The median.
double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double upper = *middle;
  if (values.size() % 2 == 1) return upper;
  return (*std::max_element(values.begin(), middle) + upper) / 2;
}

}  // namespace

std::string columns_text(const std::vector<DataColumn>& columns) {
  std::vector<std::vector<std::string>> rows = {
      {"column", "rows", "smallest", "median", "largest", "unit", "one unit"}};
  for (const DataColumn& column : columns) {
    if (column.values.empty()) continue;
    const auto [low, high] = std::minmax_element(column.values.begin(), column.values.end());
    const auto shown = [&](double si) { return plain_given(from_si(column.unit, si)); };
    rows.push_back({column.name, plain_given(static_cast<double>(column.values.size())),
                    shown(*low), shown(median(column.values)), shown(*high),
                    unit_name(column) == "1" ? "-" : unit_name(column), one_unit(column)});
  }
  if (rows.size() == 1) return "";
  return text_table(rows, true);
}

}  // namespace wearwell
