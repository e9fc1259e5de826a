#include "wearwell/models/fatigue/read_outcome.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"

namespace wearwell {

using fatigue::Outcome;

Outcome read_outcome(const Table& table, const ColumnChoice& choice, std::size_t row) {
  static const std::vector<std::pair<std::string, Outcome>> words = {
      {"failure", Outcome::failure},   {"F", Outcome::failure}, {"0", Outcome::failure},
      {"runout", Outcome::runout},     {"S", Outcome::runout},  {"1", Outcome::runout},
      {"run-out", Outcome::runout},    {"left", Outcome::left}, {"-1", Outcome::left},
      {"interval", Outcome::interval}, {"2", Outcome::interval}};
  const std::string word = cell_word(table.column(choice.column), row);
  for (const auto& [name, outcome] : words) {
    if (word == name) return outcome;
  }
  if (word == "true" || word == "false") {
    throw InputError(
        fmt::format("{}: '{}' does not say of what; write failure or runout (or F, S; or the codes "
                    "0 failure, 1 runout, -1 left, 2 interval)",
                    place(table, choice.column, row), word));
  }
  const std::vector<std::string> names = {"failure", "runout", "left", "interval"};
  throw InputError(
      fmt::format("{}: '{}' is no status; it is failure, runout, left or interval (or F, S; or the "
                  "codes 0, 1, -1, 2) (nearest: '{}')",
                  place(table, choice.column, row), word, nearest_name(word, names)));
}

}  // namespace wearwell
