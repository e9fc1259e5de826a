#include "wearwell/plan/demonstration_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/math/root.h"
#include "wearwell/present/plain.h"

namespace wearwell::plan {
namespace {

constexpr double wanted_to_pass = 0.9;  // of `DemonstrationPlan::passing`

// To four digits in the unit of the goal, so that what is shown reaches the confidence.
double rounded_up_time(const DemonstrationGoal& goal, double time) {
  const double shown = goal.shown(time);
  const double digit = std::pow(10.0, std::floor(std::log10(shown)) - 3);
  return time / shown * digit * std::ceil(shown / digit * (1 - 1e-12));
}

double life_that_passes(const DemonstrationTest& test, const DemonstrationGoal& goal) {
  if (!goal.spread)
    return boost::math::ibetac_inv(static_cast<double>(test.allowed) + 1,
                                   static_cast<double>(test.specimens - test.allowed),
                                   wanted_to_pass);
  return std::exp(solve_increasing(
      [&](double x) {
        return pass_probability(test, goal.scatter, goal.goal.failing, std::exp(x)) -
               wanted_to_pass;
      },
      0, 0.5, {1e-10, 1e-10}, -30, 60));
}

// The sought number for a scatter; none if there is none.
std::optional<double> sought_number(const DemonstrationGoal& goal, Sought sought,
                                    const DemonstrationTest& given, const Scatter& scatter) {
  const double failing = goal.goal.failing;
  if (sought == Sought::specimens) {
    const auto n = least_specimens(given.allowed, given.time, scatter, failing, goal.confidence);
    return n ? std::optional(static_cast<double>(*n)) : std::nullopt;
  }
  if (sought == Sought::time)
    return least_time(given.specimens, given.allowed, scatter, failing, goal.confidence);
  return demonstrated_confidence(given, scatter, failing);
}

void add_exposure_rule(DemonstrationPlan& plan, const DemonstrationGoal& goal, Sought sought) {
  const double shape = goal.spread->at(0), failing = goal.goal.failing;
  const auto n = static_cast<double>(plan.test.specimens);
  plan.exposure = required_exposure(plan.test.allowed, failing, goal.confidence);
  if (sought == Sought::specimens)
    plan.by_exposure = std::ceil(*plan.exposure / std::pow(plan.test.time, shape) * (1 - 1e-12));
  if (sought == Sought::time) plan.by_exposure = std::pow(*plan.exposure / n, 1 / shape);
  if (sought == Sought::confidence)
    plan.by_exposure =
        boost::math::gamma_p(static_cast<double>(plan.test.allowed) + 1,
                             -n * std::pow(plan.test.time, shape) * std::log1p(-failing));
}

DemonstrationPlan plan_of(const DemonstrationGoal& goal, Sought sought, std::size_t allowed) {
  DemonstrationPlan plan;
  plan.test = {goal.specimens.value_or(0), allowed, goal.spread ? goal.time.value_or(1) : 1};
  const auto found = sought_number(goal, sought, plan.test, goal.scatter);
  if (!found)
    throw InputError(
        sought == Sought::specimens
            ? fmt::format("--time: more than ten million specimens are needed with {} failures; "
                          "test longer",
                          allowed)
            : fmt::format("--specimens: no time up to 10^12 times the life to show is enough for "
                          "{} specimens with {} failures",
                          plan.test.specimens, allowed));
  if (sought == Sought::specimens) plan.test.specimens = static_cast<std::size_t>(*found);
  if (sought == Sought::time) plan.test.time = rounded_up_time(goal, *found);
  plan.confidence = demonstrated_confidence(plan.test, goal.scatter, goal.goal.failing);
  plan.passing = life_that_passes(plan.test, goal);
  if (!goal.spread) return plan;
  if (goal.spread->uncertain) {
    plan.low = sought_number(goal, sought, plan.test, goal.scatter_at(z05));
    plan.high = sought_number(goal, sought, plan.test, goal.scatter_at(z95));
    if (goal.weibull() && allowed == 0)
      plan.posterior = posterior_after_success(plan.test.specimens, plan.test.time, goal.scatter,
                                               goal.goal.failing);
  } else if (goal.weibull()) {
    add_exposure_rule(plan, goal, sought);
  }
  return plan;
}

}  // namespace

Demonstration demonstration_of(const DemonstrationGoal& goal) {
  Demonstration result{goal, Sought::specimens, {}, {}};
  if (goal.specimens) result.sought = goal.time || !goal.spread ? Sought::confidence : Sought::time;
  for (const std::size_t allowed : goal.failures)
    result.plans.push_back(plan_of(goal, result.sought, allowed));
  if (!goal.spread) return result;
  for (const std::size_t n : {1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 75, 100}) {
    SampleAgainstTime row{n, {}};
    for (const std::size_t allowed : goal.failures)
      row.times.push_back(least_time(n, allowed, goal.scatter, goal.goal.failing, goal.confidence));
    if (std::any_of(row.times.begin(), row.times.end(),
                    [](const auto& time) { return time.has_value(); }))
      result.sample_sizes.push_back(std::move(row));
  }
  return result;
}

std::string b_life_name(double failing) {
  return fmt::format("B{:.6g}", 100 * failing);
}

std::vector<LifePoint> true_lives(const DemonstrationGoal& goal) {
  if (!goal.truth.empty()) return goal.truth;
  std::vector<LifePoint> all;
  const std::string unit = goal.goal.unit.text == "1" ? "" : " " + goal.goal.unit.text;
  for (const double factor : {1.0, 1.5, 2.0, 3.0, 5.0, 10.0}) {
    LifePoint truth = goal.goal;
    if (goal.spread) {
      truth.life *= factor;
      truth.text = fmt::format("{} = {}{}", b_life_name(truth.failing),
                               plain_given(from_si(truth.unit, truth.life)), unit);
    } else {
      truth.failing /= factor;
      truth.text = fmt::format("reliability = {:.5g} %", 100 * (1 - truth.failing));
    }
    all.push_back(std::move(truth));
  }
  return all;
}

std::string scatter_text(const DemonstrationGoal& goal) {
  if (!goal.spread) return "no assumption on the distribution of lives (success run)";
  const std::string name = goal.weibull() ? "Weibull" : goal.distribution;
  if (!goal.spread->uncertain)
    return fmt::format("{} lives, {} {}, taken as known", name, goal.spread_name(),
                       goal.spread->text);
  return fmt::format("{} lives, {} {} ({})", name, goal.spread_name(), goal.spread->text,
                     goal.spread->prior);
}

std::string goal_text(const DemonstrationGoal& goal) {
  const std::string unit = goal.goal.unit.text == "1" ? "" : " " + goal.goal.unit.text;
  return fmt::format("reliability of at least {:.6g} % at {}{}, with {:.6g} % confidence",
                     100 * (1 - goal.goal.failing), plain_given(goal.shown(1)), unit,
                     100 * goal.confidence);
}

nlohmann::ordered_json goal_json(const DemonstrationGoal& goal) {
  nlohmann::ordered_json json = {{"text", goal.goal.text},
                                 {"reliability", 1 - goal.goal.failing},
                                 {"life", goal.shown(1)},
                                 {"unit", goal.goal.unit.text},
                                 {"confidence", goal.confidence}};
  json["distribution"] = goal.spread ? nlohmann::ordered_json(goal.distribution) : nullptr;
  if (goal.spread)
    json[goal.spread_name()] = {{"text", goal.spread->text},
                                {"known", !goal.spread->uncertain},
                                {"q05", goal.spread->at(z05)},
                                {"q50", goal.spread->at(0)},
                                {"q95", goal.spread->at(z95)}};
  return json;
}

}  // namespace wearwell::plan
