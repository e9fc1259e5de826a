#include <cmath>

#include "wearwell/input/columns.h"
#include "wearwell/plan/next_plan.h"

namespace wearwell::plan {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json candidate_json(const NextPlan& plan, const Judged& each) {
  Json json = {{"name", each.candidate.name},
               {"row", each.candidate.row + 1},
               {"specimens", each.candidate.specimens},
               {"stop", each.candidate.stop ? Json(*each.candidate.stop) : Json()}};
  Json conditions = Json::object();
  for (const ConditionColumn& condition : plan.conditions) {
    const auto& column = condition_column(plan.condition_values, condition.heading);
    conditions[condition.name] =
        condition.words ? Json(cell_word(column, each.candidate.row))
                        : finite(cell_number(plan.condition_values, column, each.candidate.row));
  }
  json["conditions"] = std::move(conditions);
  const double width = plan.expected_width(each.narrowing);
  json["narrowing"] = each.narrowing;
  json["error"] = each.narrowing_error;
  json["width"] = plan.logarithmic ? std::exp(width) : width;
  json["variance_left"] = each.variance_share;
  json["variance_error"] = each.gain.variance_error / (plan.nodes.sd * plan.nodes.sd);
  json["information"] = each.gain.information;
  json["information_error"] = each.gain.information_error;
  if (plan.loss) {
    json["saved"] = each.gain.saved;
    json["saved_error"] = each.gain.saved_error;
    json["saving"] = plan.loss->fleet_use > 0 ? Json(plan.loss->saved(each.gain.saved)) : Json();
  }
  json["test"] = plan.use_unit.empty() ? Json() : finite(each.gain.use);
  json["runouts"] = each.gain.runout;
  json["cost"] = each.cost ? Json(*each.cost) : Json();
  json["score"] = each.score;
  json["effective"] = finite(each.gain.effective);
  json["outside"] = each.candidate.outside;
  return json;
}

}  // namespace

nlohmann::ordered_json next_json(const NextPlan& plan, const NextQuestion& question) {
  Json json = {{"title", plan.title},
               {"trusted", plan.trusted},
               {"goal",
                {{"name", plan.goal.name},
                 {"unit", plan.goal.unit.text},
                 {"scale", plan.logarithmic ? "logarithmic" : "linear"},
                 {"q05", plan.in_unit(plan.now.low)},
                 {"q50", plan.in_unit(plan.now.median)},
                 {"q95", plan.in_unit(plan.now.high)},
                 {"width", plan.logarithmic ? std::exp(plan.now.width()) : plan.now.width()},
                 {"sd", plan.nodes.sd}}},
               {"by", question.by},
               {"worth_it", plan.worth_it},
               {"why_not", plan.why_not.empty() ? Json() : Json(plan.why_not)},
               {"test_unit", plan.use_unit.empty() ? Json() : Json(plan.use_unit)},
               {"currency", plan.currency.empty() ? Json() : Json(plan.currency)},
               {"nodes", plan.how.empty() ? Json(plan.points.goal.size()) : Json()},
               {"samples", question.samples},
               {"seed", question.seed},
               {"tests_done", plan.tests_done}};
  if (plan.loss)
    json["loss"] = {{"rate", plan.loss->now},
                    {"rate_known", plan.loss->known},
                    {"age", finite(plan.loss->age)},
                    {"per", plan.loss->per},
                    {"fleet_use", plan.loss->fleet_use > 0 ? Json(plan.loss->fleet_use) : Json()}};
  Json candidates = Json::array();
  for (const Judged& each : plan.judged) candidates.push_back(candidate_json(plan, each));
  json["candidates"] = std::move(candidates);
  if (plan.batch) {
    Json chosen = Json::array();
    for (const std::size_t i : plan.batch->chosen)
      chosen.push_back({{"name", plan.judged[i].candidate.name},
                        {"row", plan.judged[i].candidate.row + 1},
                        {"specimens", plan.judged[i].candidate.specimens}});
    json["batch"] = {{"chosen", std::move(chosen)},
                     {"narrowing", plan.batch->narrowing},
                     {"error", plan.batch->narrowing_error},
                     {"cost", plan.batch->cost ? Json(*plan.batch->cost) : Json()},
                     {"considered", plan.batch->shortlist}};
  }
  if (plan.target)
    json["until"] = {{"text", plan.target->text},
                     {"reached", plan.target->reached},
                     {"tests", plan.target->tests ? Json(*plan.target->tests) : Json()},
                     {"most", plan.target->most}};
  Json checks = Json::array();
  static constexpr const char* words[] = {"pass", "warn", "fail"};
  for (const Check& check : plan.checks)
    checks.push_back({{"name", check.name},
                      {"verdict", words[static_cast<int>(check.verdict)]},
                      {"detail", check.detail}});
  json["checks"] = std::move(checks);
  json["notes"] = plan.notes;
  return json;
}

}  // namespace wearwell::plan
