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
#include "wearwell/prognosis/asked_life.h"
#include "wearwell/prognosis/decision_request.h"
#include "wearwell/prognosis/decisions_tables.h"
#include "wearwell/prognosis/life_text.h"
#include "wearwell/prognosis/result_lives.h"
#include "wearwell/workbench/command_line.h"
#include "wearwell/workbench/python_line.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;
using Fields = std::span<const char* const>;

constexpr const char* life_fields[] = {"unit", "survived", "horizon", "risk", "level", "sides"};
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
    const prognosis::CarriedState state = prognosis::read_state(folder);
    prognosis::require_posterior(state, folder.filename().string());
    const prognosis::UnitLife life =
        prognosis::asked_life(state, folder.filename().string(), models, asked);
    return {{"text", prognosis::life_text(life, bounds, {}, state.trusted)},
            {"answer", prognosis::life_json(life, bounds, {}, state.trusted)},
            {"command", command_of("life", folder, question, life_fields)},
            {"python", python_of("unit_life", folder, question, life_fields)}};
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

}  // namespace wearwell::workbench
