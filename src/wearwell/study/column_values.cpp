#include "wearwell/study/column_values.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <unordered_set>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"

namespace wearwell {

std::vector<double> numbers_of(const Table& table, const Column& column) {
  std::vector<double> numbers;
  numbers.reserve(table.rows);
  // A refusal takes a thousand times as long as a number: that of each word is remembered.
  std::unordered_set<std::string_view> words;
  for (std::size_t i = 0; i < table.rows; ++i) {
    double value = NAN;
    if (column.is_number || !words.contains(column.text[i])) {
      try {
        value = cell_number(table, column, i);
      } catch (const InputError&) {
        words.insert(column.text[i]);
      }
    }
    numbers.push_back(value);
  }
  return numbers;
}

std::vector<double> values_of(const Table& table, const Column& column) {
  std::vector<double> values = numbers_of(table, column);
  std::erase_if(values, [](double each) { return !std::isfinite(each); });
  return values;
}

std::vector<std::string> kinds_of(const Table& table, const Column& column) {
  std::vector<std::string> kinds;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < table.rows; ++i) {
    const std::string word = cell_word(column, i);
    if (!word.empty() && seen.insert(word).second) kinds.push_back(word);
  }
  return kinds;
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
