#include "wearwell/study/guessed_studies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/study/role_words.h"
#include "wearwell/study/table_scope.h"

namespace wearwell {

std::vector<GuessedStudy> guessed_studies(
    Models models, const Table& table, const std::string& file, const TableChoices& choices,
    const std::string& preset, const std::vector<std::pair<std::string, StudyGuess>>& more) {
  const TableScope once(table);
  std::vector<GuessedStudy> found;
  const auto add = [&](std::string_view name, StudyGuess guess) {
    if (!guess || (!preset.empty() && name != preset)) return;
    ColumnRoles roles(table, file, choices, !preset.empty());
    auto study = guess(roles);
    if (study && study->fit != ReadingFit::none)
      found.push_back({std::string(name), std::move(*study)});
  };
  for (const Model& model : models) add(model.preset, model.scaffold);
  for (const auto& [name, guess] : more) add(name, guess);
  std::stable_sort(found.begin(), found.end(), [](const GuessedStudy& a, const GuessedStudy& b) {
    return a.study.fit > b.study.fit;
  });
  return found;
}

std::string data_lines(const std::map<std::string, std::string>& keys,
                       const std::optional<WideTable>& wide) {
  std::string text;
  for (const auto& [key, value] : keys)
    text += fmt::format("{} = {}\n", key, key == "header_row" ? value : toml_text(value));
  if (wide) text += fmt::format("sql = {}\n", toml_text(wide->sql));
  return text;
}

std::string wide_description(const WideTable& wide) {
  return fmt::format("columns {} are units with one column each: `sql` stacks their readings",
                     fmt::join(wide.units, ", "));
}

std::size_t equally_good(const std::vector<GuessedStudy>& studies) {
  return static_cast<std::size_t>(std::count_if(
      studies.begin(), studies.end(),
      [&](const GuessedStudy& each) { return each.study.fit == studies.front().study.fit; }));
}

void choose_column(const Table& table, const std::string& choice, TableChoices& choices) {
  const std::size_t at = choice.find('=');
  if (at == choice.npos)
    throw InputError(
        fmt::format("--column: '{}' is not ROLE=HEADING, like depth='wear [um]'", choice));
  const std::string role = choice.substr(0, at), heading = choice.substr(at + 1);
  try {
    if (!heading.empty()) static_cast<void>(table.column(heading));
    if (role == "unused") {
      choices.unused.push_back(heading);
      return;
    }
    static_cast<void>(role_form(role));
  } catch (const InputError& error) {
    throw InputError(fmt::format("--column {}: {}", choice, error.what()));
  }
  choices.columns[role] = heading;
}

}  // namespace wearwell
