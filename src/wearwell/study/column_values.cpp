#include "wearwell/study/column_values.h"

#include <algorithm>
#include <cmath>

#include "wearwell/study/table_scope.h"

namespace wearwell {

std::vector<double> numbers_of(const Table& table, const Column& column) {
  return *shared_numbers(table, column);
}

std::vector<double> values_of(const Table& table, const Column& column) {
  std::vector<double> values = numbers_of(table, column);
  std::erase_if(values, [](double each) { return !std::isfinite(each); });
  return values;
}

std::vector<std::string> kinds_of(const Table& table, const Column& column) {
  return *shared_kinds(table, column);
}

bool has_open_ends(const Column& column) {
  return std::any_of(column.text.begin(), column.text.end(), [](const std::string& cell) {
    return cell.starts_with('>') || cell.starts_with("\u2265");
  });
}

bool differs(const Table& table, const Column& column) {
  const std::vector<double> values = values_of(table, column);
  if (values.empty()) return kinds_of(table, column).size() > 1;
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return *largest - *least > 1e-9 * std::max(std::abs(*least), std::abs(*largest));
}

bool repeats(const Table& table, const Column& column) {
  const std::size_t kinds = kinds_of(table, column).size();
  return kinds > 1 && kinds < table.rows;
}

}  // namespace wearwell
