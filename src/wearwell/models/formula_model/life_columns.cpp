#include "wearwell/models/formula_model/life_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "wearwell/input/cell_text.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/formula_model/failure_modes.h"
#include "wearwell/study/column_values.h"
#include "wearwell/study/heading_words.h"

namespace wearwell::formula_model {
namespace {

bool has_empty_cell(const Table& table, const Column& column) {
  for (std::size_t row = 0; row < table.rows; ++row) {
    const std::string word = cell_word(column, row);
    if (word.empty() || is_missing_mark(word)) return true;
  }
  return false;
}

// A status that is the mode column itself: its empty cells are run-outs.
std::string empty_modes(ColumnRoles& roles, const Column& column) {
  const auto status = roles.choices().columns.find("status");
  if (status != roles.choices().columns.end())
    return status->second.empty()
               ? "unknown = \"\"    # an empty cell is a failure of unknown mode\n"
               : "runout = \"\"    # an empty cell is a run-out\n";
  const std::string mode = fmt::format("mode={}", column.name);
  roles.questions.push_back(
      {fmt::format("What is an empty cell of column '{}' of {}?", column.name, roles.file()),
       {{"a part that did not fail (a run-out)",
         {"--column", mode, "--column", fmt::format("status={}", column.name)}},
        {"a failure of unknown mode", {"--column", mode, "--column", "status="}}}});
  return "";
}

// "n" and "number" count the parts of a row beside a life, unless they number the rows.
const Column* short_count(const ColumnRoles& roles) {
  for (const Column* each : roles.other_numbers()) {
    const bool is_short = is_exactly(each->name, "n") || is_exactly(each->name, "number");
    if (!is_short) continue;
    const std::vector<double> values = numbers_of(roles.table(), *each);
    bool numbers_rows = true, counts = true;
    for (std::size_t i = 0; i < values.size(); ++i) {
      numbers_rows &= values[i] == static_cast<double>(i + 1);
      counts &= values[i] >= 0 && values[i] == std::floor(values[i]);
    }
    const auto is_other = [&](std::string_view role) {
      const auto found = roles.find({role});
      return found && found->column != each;
    };
    constexpr std::string_view lives[] = {"life",        "lower",  "time",
                                          "revolutions", "cycles", "distance"};
    if (counts && !numbers_rows && std::any_of(std::begin(lives), std::end(lives), is_other))
      return each;
  }
  return nullptr;
}

}  // namespace

bool has_modes(const ColumnRoles& roles) {
  const auto mode = roles.find({"mode"});
  if (!mode) return false;
  const std::size_t kinds = kinds_of(roles.table(), *mode->column).size();
  return kinds >= 2 && kinds <= FailureModes::most + 1;
}

std::string runouts_of_modes(ColumnRoles& roles, const Column& column) {
  std::vector<std::string> possible;
  bool known = false;
  for (const std::string& kind : kinds_of(roles.table(), column)) {
    if (censoring_by_word(kind) != Censoring::right && kind != "0") continue;
    known |= folded_word(kind).size() >= shortest_runout_word;
    possible.push_back("'" + kind + "'");
  }
  if (known) return "";
  if (possible.empty())
    return has_empty_cell(roles.table(), column) ? empty_modes(roles, column) : "";
  return roles.unstated_line(
      "runout",
      fmt::format(
          "the word of column '{}' that marks parts that did not fail ({} can be it, or a mode)",
          column.name, fmt::join(possible, ", ")),
      "censored");
}

std::string take_count(ColumnRoles& roles) {
  if (const auto count = roles.take("count", {"count"})) return ColumnRoles::line("count", *count);
  const Column* column = roles.choices().columns.contains("count") ? nullptr : short_count(roles);
  if (!column) return "";
  roles.guesses.push_back(
      fmt::format("column '{}' is read as the number of parts of a row", column->name));
  return ColumnRoles::line("count", roles.take_column("count", *column, role_form("count")));
}

}  // namespace wearwell::formula_model
