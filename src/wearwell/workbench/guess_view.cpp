#include "wearwell/workbench/guess_view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
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

}  // namespace

ordered_json guesses_json(const OpenTable& open, Models models, const nlohmann::json& wanted) {
  TableChoices choices;
  choices.settings = data_lines(open.settings, open.wide);
  choices.limit = wanted.value("limit", "");
  if (wanted.contains("failure")) choices.failure = wanted.at("failure").get<int>();
  for (const auto& each : wanted.value("columns", nlohmann::json::array()))
    choose_column(open.table, each.get<std::string>(), choices);
  const std::vector<GuessedStudy> found =
      guessed_studies(models, open.table, open.file, choices, wanted.value("preset", ""));
  if (found.empty()) {
    std::vector<std::string> headings;
    for (const Column& each : open.table.columns) headings.push_back(printable(each.name));
    if (headings.size() > 40) headings.resize(40);
    throw InputError(fmt::format(
        "{}: no study follows from its headings ({}). A study needs lives (life, cycles to "
        "failure, or hours with a status), a measurement (wear, volume, mass, crack) against "
        "cycles, time or distance, or stresses and lives. Name a column's role below",
        printable(open.file), fmt::join(headings, ", ")));
  }
  ordered_json json = {{"readings", ordered_json::array()}};
  const std::size_t equal = equally_good(found);
  for (const GuessedStudy& each : found) {
    ordered_json guessed = texts(each.study.guesses);
    if (open.wide) guessed.insert(guessed.begin(), printable(wide_description(*open.wide)));
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
