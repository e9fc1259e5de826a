#include "wearwell/workbench/question_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/plan/next_question.h"
#include "wearwell/prognosis/asked_life.h"
#include "wearwell/prognosis/decision_request.h"
#include "wearwell/prognosis/decisions_tables.h"
#include "wearwell/prognosis/life_text.h"
#include "wearwell/prognosis/result_lives.h"
#include "wearwell/workbench/changed_prediction.h"
#include "wearwell/workbench/command_line.h"
#include "wearwell/workbench/python_line.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;
using Fields = std::span<const char* const>;

constexpr std::size_t most_units = 200;

constexpr const char* life_fields[] = {"unit", "survived", "horizon", "risk", "level", "sides"};
constexpr const char* next_fields[] = {"goal", "grid", "specimens"};
constexpr const char* decision_fields[] = {"failure_cost",
                                           "replacement_cost",
                                           "inspection_cost",
                                           "downtime_cost",
                                           "claims",
                                           "month",
                                           "at"};

std::string field_text(const nlohmann::json& question, const char* name) {
  return printable(question.value(name, ""));
}

std::string option_of(std::string field) {
  std::replace(field.begin(), field.end(), '_', '-');
  return "--" + field;
}

std::string command_of(const char* command, const std::filesystem::path& folder,
                       const nlohmann::json& question, Fields fields) {
  // Another shell stands in another folder; a unit may be named "-1".
  std::string line = fmt::format("wearwell {} {}", command, quoted_word(folder.string()));
  for (const char* name : fields) {
    const std::string text = field_text(question, name);
    if (!text.empty()) line += fmt::format(" {}={}", option_of(name), quoted_word(text));
  }
  return line;
}

std::string python_of(const char* function, const std::filesystem::path& folder,
                      const nlohmann::json& question, Fields fields) {
  std::vector<std::pair<std::string, std::string>> arguments;
  for (const char* name : fields) arguments.emplace_back(name, field_text(question, name));
  return python_question(function, folder.string(), arguments);
}

// "--failure-cost: ..." -> "failure cost: ...": a page has fields, not options.
std::string in_fields(std::string message, Fields fields) {
  for (const std::string field : fields) {
    const std::string option = option_of(field);
    std::string name = field;
    std::replace(name.begin(), name.end(), '_', ' ');
    for (std::size_t at = 0; (at = message.find(option, at)) != message.npos;)
      message.replace(at, option.size(), name);
  }
  return message;
}

ordered_json curve_json(const prognosis::DecisionsReport& report) {
  const prognosis::Shown shown{report};
  const prognosis::CostCurve curve = prognosis::cost_curve(report);
  ordered_json json = {{"age", ordered_json::array()},
                       {"cost", ordered_json::array()},
                       {"age_unit", shown.unit()},
                       {"cost_unit", shown.rate_unit()}};
  for (std::size_t i = 0; i < curve.age.size(); ++i) {
    if (curve.end && curve.age[i] > *curve.end) break;
    json["age"].push_back(curve.age[i]);
    json["cost"].push_back(curve.cost[i]);
  }
  return json;
}

prognosis::DecisionRequest request_of(const nlohmann::json& question) {
  prognosis::DecisionRequest request;
  request.failure_cost = field_text(question, "failure_cost");
  request.replacement_cost = field_text(question, "replacement_cost");
  if (request.failure_cost.empty()) throw InputError("--failure-cost: state it: 12000 EUR");
  if (request.replacement_cost.empty()) throw InputError("--replacement-cost: state it: 900 EUR");
  request.inspection_cost = field_text(question, "inspection_cost");
  request.downtime_cost = field_text(question, "downtime_cost");
  request.claims = field_text(question, "claims");
  request.month = field_text(question, "month");
  return request;
}

}  // namespace

ordered_json life_answer(const std::filesystem::path& folder, Models models,
                         const nlohmann::json& question) {
  try {
    const auto [asked, bounds] = prognosis::read_life_request(
        {field_text(question, "unit"), field_text(question, "survived"),
         field_text(question, "horizon"), field_text(question, "risk"),
         field_text(question, "level"), field_text(question, "sides")});
    prognosis::CarriedState state = prognosis::read_state(folder);
    prognosis::require_posterior(state, folder.filename().string());
    const nlohmann::json changes = question.value("changes", nlohmann::json::object());
    state.source.study.text = with_predictions(state.source.study.text, changes, models);
    const prognosis::UnitLife life =
        prognosis::asked_life(state, folder.filename().string(), models, asked);
    ordered_json found = {{"text", prognosis::life_text(life, bounds, {}, state.trusted)},
                          {"answer", prognosis::life_json(life, bounds, {}, state.trusted)}};
    if (changes.empty()) {  // else the study is to be changed first
      found["command"] = command_of("life", folder, question, life_fields);
      found["python"] = python_of("unit_life", folder, question, life_fields);
    }
    return found;
  } catch (const InputError& error) {
    throw InputError(in_fields(error.what(), life_fields));
  }
}

ordered_json decision_answer(const std::filesystem::path& folder, Models models,
                             const nlohmann::json& question) {
  try {
    const prognosis::DecisionRequest request = request_of(question);
    const prognosis::CarriedState state = prognosis::read_state(folder);
    prognosis::require_posterior(state, folder.filename().string());
    // The title is what the command prints, so that both agree.
    prognosis::ResultLives lives =
        prognosis::lives_of_result(state, models, folder.string(), field_text(question, "at"));
    prognosis::FollowedUnits units;
    if (lives.tracker) units = prognosis::units_of_study(*lives.tracker);
    const prognosis::DecisionsReport report =
        prognosis::decide(request, std::move(lives.lives), units);
    ordered_json found = {{"text", prognosis::decisions_text(report)},
                          {"answer", prognosis::decisions_json(report)},
                          {"command", command_of("decide", folder, question, decision_fields)},
                          {"python", python_of("decide", folder, question, decision_fields)}};
    if (report.decisions.age) found["curve"] = curve_json(report);
    return found;
  } catch (const InputError& error) {
    throw InputError(in_fields(error.what(), decision_fields));
  }
}

ordered_json next_test_answer(const std::filesystem::path& folder, Models models,
                              const nlohmann::json& question) {
  try {
    plan::NextQuestion asked;
    asked.goal = field_text(question, "goal");
    asked.grid = field_text(question, "grid");
    asked.specimens = field_text(question, "specimens");
    if (asked.goal.empty()) throw InputError("--goal: state what the test is to determine: B10");
    prognosis::CarriedState state = prognosis::read_state(folder);
    prognosis::require_posterior(state, folder.filename().string());
    const plan::ReadStudy read = [models](const Source& source) {
      return read_study(source, models);
    };
    const plan::Answer answer = plan::next_test(std::move(state), folder.string(), read, asked);
    return {{"text", answer.text},
            {"answer", answer.json},
            {"command", command_of("plan next", folder, question, next_fields)},
            {"python", python_of("plan.next", folder, question, next_fields)}};
  } catch (const InputError& error) {
    throw InputError(in_fields(error.what(), next_fields));
  }
}

ordered_json followed_units(const std::filesystem::path& folder, Models models) {
  ordered_json json = {{"noun", "unit"}, {"names", ordered_json::array()}};
  const prognosis::CarriedState state = prognosis::read_state(folder);
  if (state.parameters.empty()) return json;
  const auto tracker = prognosis::tracker_where_possible(state, models);
  if (!tracker || tracker->seen().empty()) return json;
  json["noun"] = tracker->noun();
  std::string words, texts;
  for (const std::string& each : tracker->seen()) {
    if (json["names"].size() == most_units) break;
    const std::string name = printable(each);
    json["names"].push_back(name);
    words += " " + quoted_word(name);
    texts += (texts.empty() ? "" : ", ") + python_text(name);
  }
  json["all"] = tracker->seen().size();
  json["command"] = fmt::format("for unit in{}; do wearwell life {} --unit=\"$unit\"; done", words,
                                quoted_word(folder.string()));
  json["python"] =
      fmt::format("import wearwell as ww; [print(ww.unit_life({}, unit=each)) for each in [{}]]",
                  python_text(folder.string()), texts);
  return json;
}

}  // namespace wearwell::workbench
