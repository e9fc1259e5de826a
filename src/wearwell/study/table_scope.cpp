#include "wearwell/study/table_scope.h"

#include <cmath>
#include <map>
#include <unordered_set>

#include "wearwell/input/columns.h"
#include "wearwell/input/readable_cell.h"

namespace wearwell {

struct TableScope::Known {
  std::map<const Column*, std::shared_ptr<const std::vector<double>>> numbers;
  std::map<const Column*, std::shared_ptr<const std::vector<std::string>>> kinds;
};

thread_local TableScope* TableScope::current_ = nullptr;

TableScope::TableScope(const Table& table)
    : table_(table), before_(current_), known_(std::make_unique<Known>()) {
  current_ = this;
}

TableScope::~TableScope() {
  current_ = before_;
}

TableScope::Known* TableScope::known_of(const Table& table) {
  return current_ && &current_->table_ == &table ? current_->known_.get() : nullptr;
}

namespace {

// A limit (">5000") is no value.
std::vector<double> read_numbers(const Table& table, const Column& column) {
  std::vector<double> numbers;
  numbers.reserve(table.rows);
  for (std::size_t i = 0; i < table.rows; ++i) {
    const auto cell = readable_cell(table, column, i);
    numbers.push_back(cell && cell->sign == 0 ? cell->number : NAN);
  }
  return numbers;
}

std::vector<std::string> read_kinds(const Table& table, const Column& column) {
  std::vector<std::string> kinds;
  std::unordered_set<std::string> seen;
  for (std::size_t i = 0; i < table.rows; ++i) {
    std::string word = cell_word(column, i);
    if (!word.empty() && seen.insert(word).second) kinds.push_back(std::move(word));
  }
  return kinds;
}

template <class Values, class Read>
std::shared_ptr<const Values> once(std::map<const Column*, std::shared_ptr<const Values>>* known,
                                   const Table& table, const Column& column, const Read& read) {
  if (!known) return std::make_shared<const Values>(read(table, column));
  std::shared_ptr<const Values>& values = (*known)[&column];
  if (!values) values = std::make_shared<const Values>(read(table, column));
  return values;
}

}  // namespace

std::shared_ptr<const std::vector<double>> shared_numbers(const Table& table,
                                                          const Column& column) {
  TableScope::Known* const known = TableScope::known_of(table);
  return once(known ? &known->numbers : nullptr, table, column, read_numbers);
}

std::shared_ptr<const std::vector<std::string>> shared_kinds(const Table& table,
                                                             const Column& column) {
  TableScope::Known* const known = TableScope::known_of(table);
  return once(known ? &known->kinds : nullptr, table, column, read_kinds);
}

}  // namespace wearwell
