#include "wearwell/models/recurrence/grouped_counts.h"

#include <cmath>

#include "wearwell/input/columns.h"

namespace wearwell::recurrence {

bool is_grouped(const TomlReader& section) {
  if (!section.boolean("grouped").value_or(false)) return false;
  const TomlReader columns = section.required_table("columns");
  if (!columns.has("count"))
    columns.fail("count",
                 "is missing: data.grouped = true needs the number of failures of each "
                 "row since the row before");
  if (section.has("rounding"))
    section.fail("rounding",
                 "has no meaning with data.grouped = true: the ages of the failures "
                 "are known by interval");
  if (section.has("end"))
    section.fail("end",
                 "has no meaning with data.grouped = true: a unit is observed until its "
                 "last row");
  return true;
}

std::vector<std::size_t> read_counts(const TomlReader& columns, Table table,
                                     const std::optional<EventWords>& words) {
  const std::string heading = read_column(columns, "count", "1", table)->column;
  for (Column& column : table.columns) {
    if (column.name != heading || !words) continue;
    for (std::size_t row = 0; row < table.rows; ++row) {
      if (!cell_word(column, row).empty() || read_event(table, *words, row)) continue;
      if (column.is_number)
        column.numbers[row] = 0;
      else
        column.text[row] = "0";
    }
  }
  const auto choice = read_column(columns, "count", "1", table);
  const std::vector<double> numbers = si_numbers(table, *choice);
  std::vector<std::size_t> counts;
  for (std::size_t row = 0; row < table.rows; ++row) {
    constexpr double most = 1e6;
    require(numbers[row] >= 0 && numbers[row] <= most && numbers[row] == std::floor(numbers[row]),
            table, *choice, row, "a whole number from 0 to 1000000");
    counts.push_back(static_cast<std::size_t>(numbers[row]));
  }
  return counts;
}

}  // namespace wearwell::recurrence
