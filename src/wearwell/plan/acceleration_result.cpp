#include "wearwell/plan/acceleration_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/present/plain.h"

namespace wearwell::plan {
namespace {

constexpr PlanKind plan_kinds[] = {PlanKind::optimum, PlanKind::compromise, PlanKind::four_two_one,
                                   PlanKind::equal};

std::vector<TestLevel> levels_for(const AccelerationResult& result, const AccelerationGoal& goal,
                                  PlanKind kind) {
  const AccelerationTest& test = result.test;
  if (kind != PlanKind::optimum && test.low_xi >= 0)
    return best_allocation(kind, goal, result.information, test.low_xi, test.middle_share);
  return best_plan(kind, goal, result.information, test.lowest_xi, test.middle_share);
}

std::vector<StopTime> all_stop_times(const AccelerationResult& result) {
  const auto size = static_cast<double>(result.test.question.specimens);
  std::vector<StopTime> all;
  for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    AccelerationGoal goal = result.goal;
    for (PlanningPoint& each : goal.points) each.at_use += std::log(factor) / each.scale;
    const auto error = [&](PlanKind kind) {
      return std::sqrt(goal_variance(goal, result.information, levels_for(result, goal, kind)) /
                       size);
    };
    StopTime at{factor, factor * result.test.until, error(PlanKind::optimum),
                error(PlanKind::compromise), 0};
    at.specimens = size * std::pow(at.compromise, 2);
    all.push_back(at);
  }
  const double as_given = std::pow(all[2].compromise, 2);
  for (StopTime& each : all) each.specimens = std::ceil(each.specimens / as_given - 1e-9);
  return all;
}

AccelerationPlan evaluated_plan(const AccelerationResult& result, PlanKind kind) {
  const std::size_t n = result.test.question.specimens;
  AccelerationPlan plan;
  plan.kind = kind;
  plan.levels = levels_for(result, result.goal, kind);
  plan.specimens = whole_allocation(plan.levels, n);
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    plan.levels[i].share = static_cast<double>(plan.specimens[i]) / static_cast<double>(n);
    plan.failing.push_back(failing_at(result.goal, plan.levels[i]));
    plan.enough.push_back(enough_failures(result.goal, plan.levels[i], plan.specimens[i],
                                          result.test.question.least_failures));
  }
  const auto size = static_cast<double>(n);
  plan.standard_error =
      std::sqrt(goal_variance(result.goal, result.information, plan.levels) / size);
  plan.curvature_error =
      std::sqrt(curvature_variance(result.goal, result.information, plan.levels) / size);
  return plan;
}

OffValues off_values(const AccelerationResult& result, const std::string& what,
                     const std::array<double, 3>& value) {
  const AccelerationGoal goal = result.test.with(value);
  const auto size = static_cast<double>(result.test.question.specimens);
  OffValues off{what, {}, 0};
  for (const AccelerationPlan& plan : result.plans)
    off.standard_errors.push_back(
        std::sqrt(goal_variance(goal, result.information, plan.levels) / size));
  off.optimum =
      std::sqrt(goal_variance(goal, result.information,
                              best_plan(PlanKind::optimum, goal, result.information,
                                        result.test.lowest_xi, result.test.middle_share)) /
                size);
  return off;
}

// A known share is moved on the scale of odds; other values by a factor.
double moved_value(const NamedValue& value, double factor) {
  const double x = value.value.at(0);
  if (value.unit != "%") return x * factor;
  const double odds = x / (1 - x) * factor;
  return odds / (1 + odds);
}

std::string value_text(const NamedValue& value, double x) {
  const std::string unit = value.unit.empty() ? "" : " " + value.unit;
  return fmt::format("{} {}{}", value.name, plain_number(x * value.shown_by, 3), unit);
}

// Each planning value at the ends of its interval; one that is known, off by the usual error.
std::vector<OffValues> all_off_values(const AccelerationResult& result) {
  const AccelerationTest& test = result.test;
  std::vector<OffValues> all = {off_values(result, "as planned (medians)", test.medians())};
  for (std::size_t i = 0; i < 3; ++i) {
    const NamedValue& value = test.values[i];
    const double factor = value.unit == "%" ? 3 : value.option == "--life-at-highest" ? 2 : 1.25;
    for (const bool up : {false, true}) {
      std::array<double, 3> off = test.medians();
      off[i] = value.value.uncertain ? value.value.at(up ? z95 : z05)
                                     : moved_value(value, up ? factor : 1 / factor);
      if (!(test.point(off).rise > 0)) continue;
      all.push_back(off_values(result, value_text(value, off[i]), off));
    }
  }
  return all;
}

}  // namespace

AccelerationResult acceleration_of(const AccelerationTest& test) {
  AccelerationResult result{test, test.averaged(), CensoredInformation(test.distribution), {}, {},
                            {}};
  for (const PlanKind kind : plan_kinds) result.plans.push_back(evaluated_plan(result, kind));
  const std::vector<TestLevel> best = levels_for(result, result.goal, PlanKind::optimum);
  for (int i = 0; i <= 100 && test.stops.empty(); ++i)
    result.optimum_gain = std::max(
        result.optimum_gain,
        gain_at(result.goal, result.information, best, std::lerp(test.lowest_xi, 1.0, i / 100.0)));
  const std::vector<double> variances = goal_variances(result.goal, result.information, best);
  double sum = 0;
  for (std::size_t i = 0; i < variances.size(); ++i) {
    const double part = result.goal.points[i].weight * variances[i];
    sum += part;
    result.heaviest_share = std::max(result.heaviest_share, part);
  }
  result.heaviest_share /= sum;
  result.off = all_off_values(result);
  result.stop_times = all_stop_times(result);
  return result;
}

double interval_factor(double standard_error) {
  return std::exp(z95 * standard_error);
}

double noticed_departure(const AccelerationPlan& plan) {
  if (!std::isfinite(plan.curvature_error)) return std::numeric_limits<double>::infinity();
  constexpr double z_of_test = 1.959963984540054, z_of_power = 0.8416212335729143;
  const double half = 0.5 * (plan.levels.back().xi - plan.levels.front().xi);
  return std::exp((z_of_test + z_of_power) * plan.curvature_error * half * half);
}

std::string plan_name(PlanKind kind) {
  static constexpr const char* names[] = {"optimum", "compromise", "4:2:1", "equal"};
  return names[static_cast<int>(kind)];
}

std::string stress_text(const AccelerationTest& test, double xi) {
  const double shown = from_si(test.stress_unit, test.stress(xi));
  return fmt::format("{} {}",
                     std::abs(shown) < 9999.5 && std::abs(shown) >= 0.01
                         ? fmt::format("{:.4g}", shown)
                         : plain_number(shown),
                     test.stress_unit.text);
}

}  // namespace wearwell::plan
