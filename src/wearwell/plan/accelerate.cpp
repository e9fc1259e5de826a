#include "wearwell/plan/accelerate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/plan/acceleration_result.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"

namespace wearwell::plan {
namespace {

using Json = nlohmann::ordered_json;

const AccelerationPlan& compromise_of(const AccelerationResult& result) {
  return result.plans[1];
}

std::string acceleration_sentence(const AccelerationResult& result) {
  const AccelerationPlan& plan = compromise_of(result);
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < plan.levels.size(); ++i)
    parts.push_back(
        fmt::format("{} at {}", plan.specimens[i], stress_text(result.test, plan.levels[i].xi)));
  return fmt::format(
      "Compromise plan: {}. The 90 % interval of {} at {} is the estimate times and divided by "
      "{:.3g}; with the optimum plan, which cannot check the relation, by {:.3g}.",
      fmt::join(parts, ", "), result.test.question.goal, stress_text(result.test, 0),
      interval_factor(plan.standard_error), interval_factor(result.plans.front().standard_error));
}

std::string settings_sentence(const AccelerationResult& result) {
  const AccelerationTest& test = result.test;
  static constexpr const char* relations[] = {"Arrhenius relation", "Eyring relation",
                                              "inverse power relation",
                                              "log life linear in the stress"};
  std::vector<std::string> stops;
  for (const double stop : test.stops) stops.push_back(plain_given(stop / test.time_unit.scale));
  const std::string until =
      stops.empty() ? plain_given(test.until / test.time_unit.scale) + " " + test.time_unit.text
                    : fmt::format("{} {} (lower, middle, highest level)", fmt::join(stops, ", "),
                                  test.time_unit.text);
  std::string text = fmt::format(
      "{} specimens until {}; {} lives of the same scatter at all stresses; {}; highest stress "
      "{}",
      test.question.specimens, until,
      test.question.family == "weibull" ? "Weibull" : test.question.family,
      relations[static_cast<int>(test.relation)], stress_text(test, 1));
  if (test.lowest_xi > 0) text += fmt::format(", lowest {}", stress_text(test, test.lowest_xi));
  return text + ".";
}

std::string prior_sentence(const AccelerationResult& result) {
  const AccelerationTest& test = result.test;
  if (!test.uncertain())
    return "The planning values are taken as known for choosing the plan; the test estimates line "
           "and scatter from its own data. The table of sensitivity shows what happens if they are "
           "off.";
  std::vector<std::string> names;
  for (const NamedValue& each : test.values)
    if (each.value.uncertain) names.push_back(fmt::format("{} {}", each.name, each.value.text));
  return fmt::format(
      "The prior's part: variances are averaged over {} (90 % intervals or priors, {} points). The "
      "plan uses them only to choose levels and specimens; the test estimates line and scatter "
      "from its own data.",
      fmt::join(names, ", "), result.goal.points.size());
}

constexpr const char* curvature_note =
    "Standard error: of the natural logarithm of the goal, of large samples. 90 % factor: the "
    "interval is the estimate times and divided by it. Variance ratio: against the optimum. "
    "Departure noticed: the factor on life by which the middle level must lie off the line between "
    "the others to be noticed with 80 % probability (5 % test).";

struct PlanWarning {
  std::string name, text;
};

std::vector<PlanWarning> acceleration_warnings(const AccelerationResult& result) {
  std::vector<PlanWarning> all;
  const AccelerationTest& test = result.test;
  std::vector<std::string> few;
  for (const AccelerationPlan& plan : result.plans)
    for (std::size_t i = 0; i < plan.levels.size(); ++i)
      if (plan.enough[i] < 0.9)
        few.push_back(fmt::format("{} plan at {} ({:.3g} %)", plan_name(plan.kind),
                                  stress_text(test, plan.levels[i].xi),
                                  100 * (1 - plan.enough[i])));
  if (!few.empty())
    all.push_back({"few failures",
                   fmt::format("levels that may have fewer than {} failures, with their "
                               "probability: {}. The standard errors of large samples are then too "
                               "small; test longer, more specimens, or at a higher stress.",
                               test.question.least_failures, fmt::join(few, ", "))});
  if (result.optimum_gain > 1.01)
    all.push_back(
        {"levels", fmt::format("A third level could reduce the variance of the optimum plan: at "
                               "the best stress weight is worth {:.3g} times that of the plan.",
                               result.optimum_gain)});
  if (result.heaviest_share > 0.3 && result.goal.points.size() > 1)
    all.push_back(
        {"prior", fmt::format("One point of the prior makes up {:.3g} % of the mean variance: the "
                              "plan guards against an end of the intervals. Narrow them if you "
                              "can.",
                              100 * result.heaviest_share)});
  if (std::abs(result.plans.front().levels.front().xi - test.lowest_xi) < 1e-6)
    all.push_back({"lowest", fmt::format("The lower level of the optimum plan is at its bound, {}.",
                                         stress_text(test, test.lowest_xi))});
  return all;
}

Json finite_json(double x) {
  return std::isfinite(x) ? Json(x) : Json();
}

Json acceleration_json(const AccelerationResult& result) {
  const AccelerationTest& test = result.test;
  Json json = {{"question", "accelerate"},
               {"goal",
                {{"text", test.question.goal},
                 {"failing", test.failing},
                 {"at", from_si(test.stress_unit, test.use)}}},
               {"family", test.question.family},
               {"relation", test.question.relation},
               {"stress_unit", test.stress_unit.text},
               {"time_unit", test.time_unit.text},
               {"until", test.until / test.time_unit.scale},
               {"specimens", test.question.specimens},
               {"highest", from_si(test.stress_unit, test.highest)},
               {"points", result.goal.points.size()}};
  for (const NamedValue& each : test.values)
    json["planning_values"].push_back({{"name", each.name},
                                       {"unit", each.unit},
                                       {"text", each.value.text},
                                       {"known", !each.value.uncertain},
                                       {"q05", each.value.at(z05) * each.shown_by},
                                       {"q50", each.value.at(0) * each.shown_by},
                                       {"q95", each.value.at(z95) * each.shown_by}});
  for (const AccelerationPlan& plan : result.plans) {
    Json levels = Json::array();
    for (std::size_t i = 0; i < plan.levels.size(); ++i)
      levels.push_back(
          {{"stress", from_si(test.stress_unit, test.stress(plan.levels[i].xi))},
           {"transformed", plan.levels[i].xi},
           {"until", test.stop(plan.levels[i]) / test.time_unit.scale},
           {"specimens", plan.specimens[i]},
           {"failing", plan.failing[i]},
           {"expected_failures", static_cast<double>(plan.specimens[i]) * plan.failing[i]},
           {"enough_failures", plan.enough[i]}});
    json["plans"].push_back({{"plan", plan_name(plan.kind)},
                             {"standard_error", plan.standard_error},
                             {"interval_factor", interval_factor(plan.standard_error)},
                             {"curvature_error", finite_json(plan.curvature_error)},
                             {"noticed_departure", finite_json(noticed_departure(plan))},
                             {"levels", std::move(levels)}});
  }
  for (const OffValues& off : result.off) {
    Json errors = Json::array();
    for (const double error : off.standard_errors) errors.push_back(finite_json(error));
    json["sensitivity"].push_back(
        {{"true", off.what}, {"standard_errors", errors}, {"optimum", finite_json(off.optimum)}});
  }
  for (const StopTime& each : result.stop_times)
    json["stop_times"].push_back({{"factor", each.factor},
                                  {"until", each.until / test.time_unit.scale},
                                  {"optimum", finite_json(each.optimum)},
                                  {"compromise", finite_json(each.compromise)},
                                  {"specimens", finite_json(each.specimens)}});
  json["optimum_gain"] = test.stops.empty() ? Json(result.optimum_gain) : Json();
  json["warnings"] = Json::array();
  for (const PlanWarning& each : acceleration_warnings(result))
    json["warnings"].push_back({{"name", each.name}, {"detail", each.text}});
  return json;
}

std::vector<present::Section> acceleration_sections(const AccelerationResult& result) {
  present::Section plan{"plan", "Plan"};
  plan.add(present::Prose{acceleration_sentence(result), true});
  plan.add(present::Prose{settings_sentence(result)});
  for (const PlanWarning& each : acceleration_warnings(result))
    plan.add(present::Callout{"warn", each.name, each.text});
  plan.add(present::Figures{{life_stress_figure(result)}});
  plan.add(acceleration_plans_table(result));
  plan.add(present::Prose{curvature_note});
  plan.add(levels_table(result));
  plan.add(stop_times_table(result));
  present::Section values{"planning-values", "Planning values"};
  values.add(present::Prose{prior_sentence(result)});
  values.add(planning_values_table(result));
  values.add(off_values_table(result));
  values.add(present::Figures{{lower_level_figure(result)}});
  return {plan, values};
}

std::string acceleration_text(const AccelerationResult& result) {
  std::string text =
      fmt::format("Predict {} at {}\n", result.test.question.goal, stress_text(result.test, 0)) +
      wrapped(printable(settings_sentence(result)), 2, 4) + "\n" +
      wrapped(printable(acceleration_sentence(result)), 0, 2) + "\n" +
      present::text(acceleration_plans_table(result)) + wrapped(curvature_note, 2, 2) + "\n" +
      present::text(levels_table(result)) + "\n" + present::text(stop_times_table(result)) + "\n" +
      present::text(off_values_table(result)) + wrapped(printable(prior_sentence(result)), 2, 2);
  const std::vector<PlanWarning> warnings = acceleration_warnings(result);
  if (!warnings.empty()) text += "\nChecks\n";
  for (const PlanWarning& each : warnings)
    text += wrapped(fmt::format("WARN  {}: {}", each.name, printable(each.text)), 2, 8);
  return text;
}

}  // namespace

Answer accelerate(const AccelerateQuestion& question) {
  const AccelerationResult result = acceleration_of(read_acceleration(question));
  return {fmt::format("Accelerated test: {} at {}", question.goal, stress_text(result.test, 0)),
          acceleration_text(result), acceleration_sections(result), acceleration_json(result)};
}

}  // namespace wearwell::plan
