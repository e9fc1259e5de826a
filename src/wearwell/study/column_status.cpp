// The part of ColumnRoles that handles status columns (how lives ended).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/life_status.h"
#include "wearwell/study/column_roles.h"
#include "wearwell/study/column_values.h"

namespace wearwell {
namespace {

// Whether every cell states how a life ended, if this code means failure.
bool says_status(const Table& table, const Column& column, std::optional<int> failure) {
  const LifeStatus status{column.name, failure};
  try {
    for (std::size_t i = 0; i < table.rows; ++i) {
      if (!cell_word(column, i).empty()) seen_in(table, status, i);
    }
  } catch (const InputError&) {
    return false;
  }
  return true;
}

bool has_codes(const Table& table, const Column& column) {
  return !says_status(table, column, {}) &&
         (says_status(table, column, 0) || says_status(table, column, 1));
}

bool few_kinds(const Table& table, const Column& column) {
  constexpr std::size_t most = 6;
  const std::size_t kinds = kinds_of(table, column).size();
  return kinds > 0 && kinds <= most;
}

}  // namespace

const Column* ColumnRoles::status_column(bool of_lives) const {
  if (const Column* column = chosen("status")) return column;
  if (choices_.columns.contains("status")) return nullptr;
  for (const Match& each : matches(role_form("status"))) {
    const Column& column = *each.found.column;
    if (few_kinds(table_, column) && (!column.is_number || has_codes(table_, column)))
      return &column;
  }
  if (!of_lives) return nullptr;
  for (const Column& column : table_.columns) {
    if (!is_free(column) || kinds_of(table_, column).size() < 2) continue;
    const bool words = !column.is_number && few_kinds(table_, column);
    if (words && (says_status(table_, column, {}) || has_codes(table_, column))) return &column;
    if (column.is_number && kinds_of(table_, column).size() == 2 && has_codes(table_, column))
      return &column;
  }
  return nullptr;
}

std::optional<std::string> ColumnRoles::take_status(bool of_lives) {
  roles_.emplace("status");
  const Column* column = status_column(of_lives);
  if (!column) return {};
  used_.push_back(column);
  const std::string plain = fmt::format("status = {}\n", toml_text(column->name));
  const std::vector<std::string> kinds = kinds_of(table_, *column);
  if (!has_codes(table_, *column)) {
    taken.push_back(fmt::format("status: column '{}' ({})", column->name, fmt::join(kinds, ", ")));
    return plain;
  }
  const std::optional<int> of_heading = failure_code_of(column->name);
  const std::optional<int> failure = choices_.failure ? choices_.failure : of_heading;
  const auto coded = [&](int code) {
    std::string failed, went_on;
    for (std::size_t i = 0; i < table_.rows; ++i) {
      const std::string word = cell_word(*column, i);
      if (word.empty()) continue;
      const Censoring seen = seen_in(table_, LifeStatus{column->name, code}, i);
      if (seen == Censoring::none) failed = word;
      if (seen == Censoring::right) went_on = word;
    }
    const std::string ends =
        failed.empty() ? "no row is a failure" : fmt::format("{} is a failure", failed);
    return went_on.empty() ? ends
                           : fmt::format("{}, {} was stopped unbroken (censored)", ends, went_on);
  };
  if (!failure) {
    TableQuestion question{fmt::format("What is a failure in column '{}' ({}) of {}?", column->name,
                                       fmt::join(kinds, ", "), file_),
                           {}};
    for (const int code : {1, 0}) {
      if (!says_status(table_, *column, code)) continue;
      question.readings.push_back(
          {coded(code),
           {"--column", "status=" + column->name, "--failure", fmt::format("{}", code)}});
    }
    question.readings.push_back({fmt::format("'{}' does not state how a life ended", column->name),
                                 {"--column", "unused=" + column->name}});
    questions.push_back(std::move(question));
    return plain;
  }
  taken.push_back(fmt::format("status: column '{}': {}: {}", column->name, coded(*failure),
                              choices_.failure ? "your choice" : "from the heading"));
  if (!choices_.failure) return plain;
  return fmt::format("status = {{ column = {}, failure = {} }}\n", toml_text(column->name),
                     *failure);
}

void ColumnRoles::refuse_status() {
  const Column* column = status_column(false);
  if (!column || chosen("status")) return;
  used_.push_back(column);
  unused_statuses_.push_back(column->name);
  guesses.push_back(fmt::format(
      "column '{}' looks like a status, but each row is a reading; the column is not used",
      column->name));
}

}  // namespace wearwell
