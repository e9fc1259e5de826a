#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/plan/acceleration_result.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"

namespace wearwell::plan {
namespace {

namespace colour = plot::colour;

present::Cell finite_cell(double x) {
  present::Cell cell;
  if (std::isfinite(x)) cell = x;
  return cell;
}

double shown_stress(const AccelerationTest& test, double xi) {
  return from_si(test.stress_unit, test.stress(xi));
}

// The time by which a share fails at xi, in the unit of the stop time, at the planning medians.
double planned_life(const AccelerationTest& test, double share, double xi) {
  const PlanningPoint point = test.point(test.medians());
  const double reach = standardized_stop(test.at_medians(), point, {xi, 1});
  const double log_ratio = point.scale * (quantile(test.distribution, share) - reach);
  return test.until / test.time_unit.scale * std::exp(log_ratio);
}

// Ticks at round stresses: the axis is even in the transformed stress.
std::vector<std::pair<double, std::string>> stress_ticks(const AccelerationTest& test) {
  const double from = shown_stress(test, 0), to = shown_stress(test, 1);
  const double raw = (to - from) / 6, power = std::pow(10.0, std::floor(std::log10(raw)));
  const double step = power * (raw / power < 1.5   ? 1
                               : raw / power < 3.5 ? 2
                               : raw / power < 7   ? 5
                                                   : 10);
  std::vector<std::pair<double, std::string>> ticks;
  for (double at = std::ceil(from / step - 1e-9) * step; at <= to * (1 + 1e-12); at += step)
    ticks.emplace_back(test.xi(to_si(test.stress_unit, at)),
                       plain_given(std::round(at * 1e9) / 1e9));
  return ticks;
}

plot::Axis stress_axis(const AccelerationTest& test, const char* name, double low, double high) {
  plot::Axis axis{fmt::format("{} [{}]", name, html::unit(test.stress_unit.text)), false, low,
                  high};
  axis.ticks = stress_ticks(test);
  return axis;
}

const char* acceleration_colour(std::size_t i) {
  return colour::chains[i % 4];
}

}  // namespace

present::Table acceleration_plans_table(const AccelerationResult& result) {
  const double best = result.plans.front().standard_error;
  present::Table table{"plans",
                       fmt::format("Plans: precision of {} at {}", result.test.question.goal,
                                   stress_text(result.test, 0)),
                       {{"plan"},
                        {"standard error", "1", present::digits(4)},
                        {"90 % factor", "1", present::digits(3)},
                        {"variance ratio", "1", present::digits(3)},
                        {"error of curvature", "1", present::digits(3)},
                        {"departure noticed", "1", present::digits(3)}}};
  for (const AccelerationPlan& plan : result.plans)
    table.rows.push_back({plan_name(plan.kind), plan.standard_error,
                          interval_factor(plan.standard_error),
                          std::pow(plan.standard_error / best, 2),
                          finite_cell(plan.curvature_error), finite_cell(noticed_departure(plan))});
  return table;
}

present::Table levels_table(const AccelerationResult& result) {
  const AccelerationTest& test = result.test;
  present::Table table{
      "levels",
      test.stops.empty()
          ? fmt::format("Levels and specimens, each until {} {}",
                        plain_given(test.until / test.time_unit.scale), test.time_unit.text)
          : "Levels, their stop times and specimens",
      {{"plan"},
       {"stress", test.stress_unit.text, present::digits(4)},
       {"specimens", "1", present::given},
       {"share", "%", present::digits(3)},
       {"fail", "%", present::digits(3)},
       {"failures expected", "1", present::digits(3)},
       {fmt::format("{} or more", test.question.least_failures), "%", present::digits(3)}}};
  const auto stop_place = table.columns.begin() + 2;
  if (!test.stops.empty())
    table.columns.insert(stop_place, {"stop time", test.time_unit.text, present::digits(4)});
  for (const AccelerationPlan& plan : result.plans)
    for (std::size_t i = 0; i < plan.levels.size(); ++i) {
      std::vector<present::Cell> row = {plan_name(plan.kind),
                                        shown_stress(test, plan.levels[i].xi),
                                        present::count(plan.specimens[i]),
                                        100 * plan.levels[i].share,
                                        100 * plan.failing[i],
                                        present::count(plan.specimens[i]) * plan.failing[i],
                                        100 * plan.enough[i]};
      if (!test.stops.empty())
        row.insert(row.begin() + 2, test.stop(plan.levels[i]) / test.time_unit.scale);
      table.rows.push_back(std::move(row));
    }
  return table;
}

present::Table stop_times_table(const AccelerationResult& result) {
  const AccelerationTest& test = result.test;
  const bool by_level = !test.stops.empty();
  present::Table table{"stop-times",
                       fmt::format("Stop time against specimens: precision of {} at {}",
                                   test.question.goal, stress_text(test, 0)),
                       {by_level ? present::Column{"times the stop times"}
                                 : present::Column{"stop time", test.time_unit.text},
                        {"optimum", "1", present::digits(4)},
                        {"compromise", "1", present::digits(4)},
                        {"90 % factor", "1", present::digits(3)},
                        {"specimens for the planned precision", "1", present::given}}};
  table.columns.front().format = present::digits(4);
  for (const StopTime& each : result.stop_times)
    table.rows.push_back({by_level ? each.factor : each.until / test.time_unit.scale,
                          finite_cell(each.optimum), finite_cell(each.compromise),
                          finite_cell(interval_factor(each.compromise)),
                          finite_cell(each.specimens)});
  return table;
}

present::Table off_values_table(const AccelerationResult& result) {
  present::Table table{
      "sensitivity", "Standard error of log life if the planning values are off", {{"true value"}}};
  for (const AccelerationPlan& plan : result.plans)
    table.columns.push_back({plan_name(plan.kind), "1", present::digits(4)});
  table.columns.push_back({"best for this", "1", present::digits(4)});
  for (const OffValues& off : result.off) {
    std::vector<present::Cell> row = {off.what};
    for (const double error : off.standard_errors) row.push_back(finite_cell(error));
    row.push_back(finite_cell(off.optimum));
    table.rows.push_back(std::move(row));
  }
  return table;
}

present::Table planning_values_table(const AccelerationResult& result) {
  present::Table table{
      "planning-values",
      "Planning values",
      {{"value"}, {"unit"}, {"median"}, {"90 % interval", "1", {}, true}, {"how"}}};
  for (const NamedValue& each : result.test.values) {
    const auto at = [&](double z) { return each.value.at(z) * each.shown_by; };
    std::vector<present::Cell> row = {each.name, each.unit, at(0), std::monostate(),
                                      std::string("taken as known")};
    if (each.value.uncertain) {
      row[3] = present::Range{at(z05), at(z95)};
      row[4] = each.value.prior;
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

html::Figure life_stress_figure(const AccelerationResult& result) {
  const AccelerationTest& test = result.test;
  const std::string unit = html::unit(test.time_unit.text);
  std::vector<plot::Json> marks;
  std::vector<double> xi, low, high, goal, median;
  for (int i = 0; i <= 40; ++i) {
    xi.push_back(i / 40.0);
    low.push_back(planned_life(test, 0.05, xi.back()));
    high.push_back(planned_life(test, 0.95, xi.back()));
    median.push_back(planned_life(test, 0.5, xi.back()));
    goal.push_back(planned_life(test, test.failing, xi.back()));
  }
  marks.push_back(plot::area({{"x", xi}, {"y", high}, {"y2", low}},
                             {colour::posterior, "5 to 95 % of lives", 0.2}));
  marks.push_back(plot::line({{"x", xi}, {"y", median}}, {colour::posterior, "median"}));
  marks.push_back(
      plot::line({{"x", xi}, {"y", goal}}, {colour::posterior, test.question.goal, 1, 2, true}));
  const double until = test.until / test.time_unit.scale;
  if (test.stops.empty())
    marks.push_back(plot::horizontal_line(until, {colour::limit, "stop time", 1, 1.5, true}));
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const AccelerationPlan& plan = result.plans[i];
    std::vector<double> x, y, n, expected;
    for (std::size_t k = 0; k < plan.levels.size(); ++k) {
      x.push_back(plan.levels[k].xi);
      // The plans apart, about the stop time.
      const double stop = test.stop(plan.levels[k]) / test.time_unit.scale;
      y.push_back(stop * (i == 0 ? 1.25 : 0.8));
      n.push_back(present::count(plan.specimens[k]));
      expected.push_back(n.back() * plan.failing[k]);
      // Neighbours at two heights: on a phone they would stand on each other.
      const double away = k % 2 == 0 ? 1.9 : 3.4;
      marks.push_back(plot::text(x.back(), i == 0 ? stop * away : stop / away,
                                 fmt::format("{:.0f} of {}", expected.back(), plan.specimens[k]),
                                 i == 0 ? colour::measured : colour::chains[2]));
    }
    marks.push_back(
        plot::points({{"x", x}, {"y", y}, {"specimens", n}, {"expected failures", expected}},
                     {i == 0 ? colour::measured : colour::chains[2], plan_name(plan.kind) + " plan",
                      1, 2, false, 70}));
  }
  return {"life-stress",
          "Life by stress, as planned",
          "Lives at the medians of the planning values, and the levels of two plans with their "
          "expected failures of so many specimens. The stress axis is even in the transformed "
          "stress.",
          plot::plot("Life against stress", stress_axis(test, "Stress", -0.15, 1.06),
                     {fmt::format("Life [{}]", unit), true}, std::move(marks), 320),
          {},
          true};
}

html::Figure lower_level_figure(const AccelerationResult& result) {
  const AccelerationTest& test = result.test;
  const auto size = static_cast<double>(test.question.specimens);
  std::vector<plot::Json> marks;
  const double best = result.plans.front().standard_error;
  double reach = 0;
  for (const AccelerationPlan& plan : result.plans) reach = std::max(reach, plan.standard_error);
  reach = std::max(2.5 * best, 1.1 * reach);
  for (std::size_t i = 0; i < result.plans.size(); ++i) {
    const AccelerationPlan& plan = result.plans[i];
    std::vector<double> x, y;
    for (int k = 0; k <= 60; ++k) {
      const double xi = std::lerp(test.lowest_xi, 0.95, k / 60.0);
      const double error =
          std::sqrt(goal_variance(result.goal, result.information,
                                  best_allocation(plan.kind, result.goal, result.information, xi,
                                                  test.middle_share)) /
                    size);
      if (!(error < reach)) continue;
      x.push_back(xi);
      y.push_back(error);
    }
    marks.push_back(
        plot::line({{"x", x}, {"y", y}}, {acceleration_colour(i), plan_name(plan.kind)}));
    marks.push_back(plot::points({{"x", {plan.levels.front().xi}}, {"y", {plan.standard_error}}},
                                 {acceleration_colour(i)}));
  }
  return {"lower-level",
          "Standard error by the lower level",
          fmt::format("Standard error of log {} at the use condition by the lower level of the "
                      "plan, its allocation the best. Points are the plans of the table.",
                      test.question.goal),
          plot::plot("Standard error against the lower level",
                     stress_axis(test, "Lower level", test.lowest_xi - 0.02, 1),
                     {"Standard error of log life", false, 0.0, reach}, std::move(marks), 320),
          {},
          true};
}

}  // namespace wearwell::plan
