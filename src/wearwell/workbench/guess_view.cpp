#include "wearwell/workbench/guess_view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/date_text.h"
#include "wearwell/study/column_roles.h"
#include "wearwell/study/guessed_studies.h"
#include "wearwell/study/role_words.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;

ordered_json texts(const std::vector<std::string>& all) {
  ordered_json json = ordered_json::array();
  for (const std::string& each : all) json.push_back(printable(each));
  return json;
}

ordered_json question_json(const TableQuestion& question) {
  ordered_json json = {{"text", printable(question.text)}, {"readings", ordered_json::array()}};
  for (const TableReading& each : question.readings)
    json["readings"].push_back({{"text", printable(each.text)}, {"options", each.options}});
  return json;
}

// Chosen roles name the headings of the file: a wide table is then read without its SELECT, as
// `wearwell new --column` does. Answers to questions about the stacked table name its headings.
bool is_stacked(const OpenTable& open, const std::vector<std::string>& chosen) {
  if (!open.wide || chosen.empty()) return open.wide.has_value();
  try {
    TableChoices unused;
    for (const std::string& each : chosen) choose_column(open.as_stored, each, unused);
    return false;
  } catch (const InputError&) {
    return true;
  }
}

// Numbers side by side without a word that says more: one of them may be a response to the others.
std::optional<Scaffold> response_question(ColumnRoles& roles) {
  constexpr std::size_t most = 40;
  const std::vector<const Column*> numbers = roles.other_numbers();
  if (numbers.size() < 2 || numbers.size() > most || roles.table().rows <= numbers.size() ||
      roles.has({"life", "status"}) || !roles.choices().columns.empty() ||
      !columns_of_dates(roles.table()).empty())
    return {};
  TableQuestion question{fmt::format("Which column of {} is the measured response?", roles.file()),
                         {}};
  for (const Column* each : numbers)
    question.readings.push_back({fmt::format("'{}', under the others as conditions", each->name),
                                 {"--column", "response=" + each->name}});
  roles.questions.push_back(std::move(question));
  Scaffold asked = roles.study("a response under its conditions", ReadingFit::possible, "");
  asked.guesses.clear();  // which column is not used follows from the answer
  return asked;
}

}  // namespace

ordered_json guesses_json(const OpenTable& open, Models models, const nlohmann::json& wanted) {
  const auto chosen = wanted.value("columns", std::vector<std::string>{});
  const bool stacked = is_stacked(open, chosen);
  const Table& table = open.wide && !stacked ? open.as_stored : open.table;
  TableChoices choices;
  choices.settings = data_lines(open.settings, stacked ? open.wide : std::nullopt);
  choices.limit = wanted.value("limit", "");
  if (wanted.contains("failure")) choices.failure = wanted.at("failure").get<int>();
  for (const std::string& each : chosen) choose_column(table, each, choices);
  std::vector<GuessedStudy> found =
      guessed_studies(models, table, open.file, choices, wanted.value("preset", ""));
  if (found.empty())
    found = guessed_studies({}, table, open.file, choices, "", {{"formula", response_question}});
  if (found.empty()) {
    std::vector<std::string> headings;
    for (const Column& each : table.columns) headings.push_back(printable(each.name));
    if (headings.size() > 40) headings.resize(40);
    std::string dates = columns_of_dates(table);
    if (!dates.empty())
      dates +=
          ", not numbers: choose dates in a heading, which makes a time of them; without a time ";
    throw InputError(fmt::format(
        "{}: {}no study follows from its headings ({}). A study needs lives (life, cycles to "
        "failure, or hours with a status), a measurement (wear, volume, mass, crack) against "
        "cycles, time or distance, stresses and lives, or a response under conditions. Choose the "
        "role of a column in its heading, or in the step Model",
        printable(open.file), dates, fmt::join(headings, ", ")));
  }
  ordered_json json = {{"readings", ordered_json::array()}};
  const std::size_t equal = equally_good(found);
  for (const GuessedStudy& each : found) {
    ordered_json guessed = texts(each.study.guesses);
    if (stacked) guessed.insert(guessed.begin(), printable(wide_description(*open.wide)));
    ordered_json reading = {{"preset", each.preset},
                            {"reading", printable(each.study.reading)},
                            {"equal", json["readings"].size() < equal},
                            {"text", each.study.text},
                            {"taken", texts(each.study.taken)},
                            {"guesses", std::move(guessed)},
                            {"unstated", texts(each.study.unstated)},
                            {"questions", ordered_json::array()}};
    for (const TableQuestion& question : each.study.questions)
      reading["questions"].push_back(question_json(question));
    json["readings"].push_back(std::move(reading));
  }
  return json;
}

}  // namespace wearwell::workbench
