// The part of ColumnRoles that handles status columns (how lives ended).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/input/cell_text.h"
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

// What empty cells mean where only one reading fits the others, and why.
struct EmptyCells {
  Censoring seen;
  const char* why;
};

std::optional<EmptyCells> empty_cells(const Table& table, const LifeStatus& status,
                                      const Column* modes) {
  std::size_t failures = 0, runouts = 0, empty = 0, with_mode = 0;
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (cell_word(table.column(status.column), i).empty()) {
      ++empty;
      const std::string mode = modes ? cell_word(*modes, i) : "";
      with_mode += !mode.empty() && !is_missing_mark(mode);
      continue;
    }
    const Censoring seen = seen_in(table, status, i);
    if (seen != Censoring::none && seen != Censoring::right) return {};
    ++(seen == Censoring::none ? failures : runouts);
  }
  if (empty == 0) return {};
  if (with_mode == empty) return EmptyCells{Censoring::none, "those rows have a failure mode"};
  if (with_mode > 0) return {};
  if (runouts == 0) return EmptyCells{Censoring::right, "all others are failures"};
  if (failures == 0 && !modes) return EmptyCells{Censoring::none, "all others are run-outs"};
  return {};
}

// The line of a study that names the column.
struct StatusKeys {
  std::string heading, keys, remark, guess;

  // `stated` is the code of a failure as the user gave it.
  StatusKeys(const Table& table, const LifeStatus& status, std::optional<int> stated,
             const Column* modes)
      : heading(toml_text(status.column)) {
    if (stated) keys = fmt::format(", failure = {}", *stated);
    if (!says_status(table, table.column(status.column), status.failure_code)) return;
    const auto empty = empty_cells(table, status, modes);
    if (!empty) return;
    const bool failed = empty->seen == Censoring::none;
    if (failed && stated) return;  // the key has no room for a word
    keys += failed ? ", failure = \"\"" : ", runout = \"\"";
    remark = fmt::format("    # GUESS: an empty cell is a {}", failed ? "failure" : "run-out");
    guess = fmt::format("an empty cell of column '{}' is read as a {}: {}", status.column,
                        failed ? "failure" : "run-out", empty->why);
  }
  std::string line() const {
    return keys.empty() ? fmt::format("status = {}\n", heading)
                        : fmt::format("status = {{ column = {}{} }}{}\n", heading, keys, remark);
  }
};

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
  if (!column || std::find(used_.begin(), used_.end(), column) != used_.end()) return {};
  used_.push_back(column);
  const std::vector<std::string> kinds = kinds_of(table_, *column);
  const bool codes = has_codes(table_, *column);
  const std::optional<int> of_heading = failure_code_of(column->name);
  const std::optional<int> failure = choices_.failure ? choices_.failure : of_heading;
  const Column* modes = nullptr;  // of failure, which were taken before
  for (const Column* each : used_)
    if (chosen("mode") == each || match(*each, role_form("mode"), false)) modes = each;
  StatusKeys keys(table_, {column->name, codes ? failure : std::nullopt},
                  codes ? choices_.failure : std::nullopt, modes);
  const std::string plain = keys.line();
  if (!keys.guess.empty()) guesses.push_back(keys.guess);
  if (!codes) {
    taken.push_back(fmt::format("status: column '{}' ({})", column->name, fmt::join(kinds, ", ")));
    return plain;
  }
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
  return plain;
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
