#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "wearwell/input/columns.h"
#include "wearwell/plan/next_plan.h"
#include "wearwell/present/plot.h"

namespace wearwell::plan {
namespace {

namespace colour = plot::colour;

// A density of the goal from weighted nodes, smoothed by a normal kernel of Silverman's width.
std::vector<double> smoothed(const std::vector<double>& goal, const std::vector<double>& weight,
                             const std::vector<double>& at) {
  const GoalSpread spread = goal_spread(goal, weight);
  const double sum = std::accumulate(weight.begin(), weight.end(), 0.0);
  const double iqr_sd = std::min(spread.sd, spread.width() / 3.29);
  const double width = 1.06 * iqr_sd * std::pow(effective_number(weight), -0.2);
  std::vector<double> density;
  for (const double x : at) {
    double total = 0;
    for (std::size_t j = 0; j < goal.size(); ++j) {
      const double z = (x - goal[j]) / width;
      if (std::abs(z) < 8) total += weight[j] * std::exp(-0.5 * z * z);
    }
    density.push_back(total / (sum * width * 2.5066282746310002));
  }
  return density;
}

std::string goal_title(const NextPlan& plan) {
  const std::string unit = plan.goal.unit.text;
  return unit == "1" ? plan.goal.name : fmt::format("{} [{}]", plan.goal.name, html::unit(unit));
}

html::Figure posterior_figure(const NextPlan& plan) {
  const GoalSpread now = plan.nodes;
  std::vector<double> at, x;
  constexpr int points = 160;
  for (int i = 0; i <= points; ++i) {
    at.push_back(now.median + (static_cast<double>(i) / points - 0.5) * 2.4 * now.width());
    x.push_back(plan.in_unit(at.back()));
  }
  const std::vector<double> before = smoothed(plan.points.goal, plan.points.weight, at),
                            after = smoothed(plan.points.goal, plan.typical, at);
  return {"goal", "The goal today and after the best candidate",
          "Posterior density today, and a typical one after the best candidate: of all simulated "
          "results the one whose spread is nearest to the expected one.",
          plot::plot("Density of the goal today and after the best candidate",
                     {goal_title(plan), plan.logarithmic, x.front(), x.back()},
                     {"Density", false, 0.0, {}, {}, false},
                     {plot::area({{"x", x}, {"y", before}}, {colour::prior, "today", 0.25}),
                      plot::line({{"x", x}, {"y", after}}, {colour::posterior, "after the best"})},
                     280)};
}

// What the ranking is about, of each of NextPlan::judged.
struct Measure {
  std::string name, unit, of_what;
  std::vector<double> value;

  std::string title() const { return fmt::format("{} [{}]", name, html::unit(unit)); }
};

Measure measure_of(const NextPlan& plan) {
  Measure measure{"Expected narrowing", "%", "Expected narrowing of the interval", {}};
  const bool money = plan.loss && plan.loss->fleet_use > 0;
  if (money)
    measure = {
        "Expected saving", plan.currency.empty() ? "cost" : plan.currency, "Expected saving", {}};
  else if (plan.loss)
    measure = {"Expected saving", "%", "Expected share of the cost saved", {}};
  for (const Judged& each : plan.judged)
    measure.value.push_back(money       ? plan.loss->saved(each.gain.saved)
                            : plan.loss ? 100 * plan.loss->share(each.gain.saved)
                                        : 100 * each.narrowing);
  return measure;
}

// Gain against cost, with those that no other candidate beats in both.
std::optional<html::Figure> pareto_figure(const NextPlan& plan, const Measure& measure) {
  const bool costs = plan.judged.front().cost.has_value();
  if (!costs && plan.use_unit.empty()) return {};
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < plan.judged.size(); ++i) {
    const Judged& each = plan.judged[i];
    points.emplace_back(costs ? *each.cost : each.gain.use * each.candidate.specimens,
                        measure.value[i]);
  }
  if (points.size() < 2) return {};
  std::vector<double> x, y;
  bool positive = true;
  for (const auto& [cost, gain] : points) {
    x.push_back(cost), y.push_back(gain);
    positive = positive && cost > 0;
  }
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.first < b.first || (a.first == b.first && a.second > b.second);
  });
  std::vector<double> front_x, front_y;
  for (const auto& [cost, gain] : points) {
    if (!front_y.empty() && gain <= front_y.back()) continue;
    front_x.push_back(cost), front_y.push_back(gain);
  }
  const double low = points.front().first, high = points.back().first;
  if (!(high > low)) return {};
  const bool logarithmic = positive && high > 20 * low;
  const std::string unit = costs ? plan.currency : plan.use_unit;
  const std::string name = costs ? "Cost" : "Expected time on test, all specimens";
  return html::Figure{
      "pareto", costs ? "Gain against cost" : "Gain against time on test",
      fmt::format("Each point is a candidate. On the line are those that no other candidate beats "
                  "in both gain and {}.",
                  costs ? "cost" : "time"),
      plot::plot(
          measure.of_what + " against cost",
          {unit.empty() ? name : fmt::format("{} [{}]", name, html::unit(unit)), logarithmic},
          {measure.title(), false, 0.0},
          {plot::points({{"x", x}, {"y", y}}, {colour::posterior, "candidate", 0.6, 2, false, 40}),
           plot::line({{"x", front_x}, {"y", front_y}}, {colour::measured, "not beaten"})},
          280)};
}

// A quantity that differs between candidates: a condition or the stop.
struct Varying {
  std::string name, unit;
  std::vector<double> value;  // of each of NextPlan::judged
  std::vector<double> levels;
};

std::vector<Varying> varying_of(const NextPlan& plan) {
  std::vector<Varying> all;
  const auto add = [&](const std::string& name, const std::string& unit, const auto& value_of) {
    Varying varying{name, unit, {}, {}};
    std::set<double> levels;
    for (const Judged& each : plan.judged) {
      varying.value.push_back(value_of(each.candidate));
      if (std::isnan(varying.value.back())) return;
      levels.insert(varying.value.back());
    }
    varying.levels.assign(levels.begin(), levels.end());
    if (levels.size() >= 2) all.push_back(std::move(varying));
  };
  for (const ConditionColumn& each : plan.conditions) {
    if (each.words) continue;
    const Column& column = condition_column(plan.condition_values, each.heading);
    add(each.name, each.unit.text, [&](const Candidate& candidate) {
      return cell_number(plan.condition_values, column, candidate.row);
    });
  }
  add("stop", plan.use_unit,
      [](const Candidate& candidate) { return candidate.stop.value_or(NAN); });
  return all;
}

std::string plain_name(const Varying& varying) {
  std::string name = varying.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string axis_title(const Varying& varying) {
  const std::string name = html::capital(plain_name(varying));
  return varying.unit.empty() || varying.unit == "1"
             ? name
             : fmt::format("{} [{}]", name, html::unit(varying.unit));
}

// Whether steps are ratios rather than differences.
bool by_ratio(const std::vector<double>& levels) {
  return levels.front() > 0 && levels.back() > 8 * levels.front();
}

// Edges of the cells between levels.
std::vector<double> edges_of(const std::vector<double>& levels) {
  const bool ratio = by_ratio(levels);
  const auto to = [&](double x) { return ratio ? std::log(x) : x; };
  const auto from = [&](double x) { return ratio ? std::exp(x) : x; };
  std::vector<double> edges;
  const std::size_t n = levels.size();
  edges.push_back(from(1.5 * to(levels[0]) - 0.5 * to(levels[1])));
  for (std::size_t i = 1; i < n; ++i)
    edges.push_back(from(0.5 * (to(levels[i - 1]) + to(levels[i]))));
  edges.push_back(from(1.5 * to(levels[n - 1]) - 0.5 * to(levels[n - 2])));
  return edges;
}

html::Figure map_figure(const NextPlan& plan, const Measure& measure, const Varying& x,
                        const Varying& y, int specimens) {
  std::map<std::pair<double, double>, double> gains;
  for (std::size_t i = 0; i < plan.judged.size(); ++i) {
    if (plan.judged[i].candidate.specimens != specimens) continue;
    const auto [at, fresh] = gains.emplace(std::pair{x.value[i], y.value[i]}, measure.value[i]);
    if (!fresh) at->second = std::max(at->second, measure.value[i]);
  }
  const std::vector<double> edges_x = edges_of(x.levels), edges_y = edges_of(y.levels);
  const auto place = [](const std::vector<double>& levels, double value) {
    return static_cast<std::size_t>(std::lower_bound(levels.begin(), levels.end(), value) -
                                    levels.begin());
  };
  std::vector<double> x1, x2, y1, y2, gain;
  for (const auto& [at, value] : gains) {
    const std::size_t i = place(x.levels, at.first), j = place(y.levels, at.second);
    x1.push_back(edges_x[i]), x2.push_back(edges_x[i + 1]);
    y1.push_back(edges_y[j]), y2.push_back(edges_y[j + 1]);
    gain.push_back(value);
  }
  const double high = *std::max_element(gain.begin(), gain.end());
  return {
      "map", fmt::format("Gain over {} and {}", plain_name(x), plain_name(y)),
      fmt::format("{} by {}, where other conditions differ that of the best.", measure.of_what,
                  specimens == 1 ? "one specimen" : fmt::format("{} specimens", specimens)),
      plot::plot(fmt::format("{} over {} and {}", measure.of_what, x.name, y.name),
                 {axis_title(x), by_ratio(x.levels), edges_x.front(), edges_x.back()},
                 {axis_title(y), by_ratio(y.levels), edges_y.front(), edges_y.back()},
                 {plot::heat_map({{"x", x1}, {"x2", x2}, {"y", y1}, {"y2", y2}, {"density", gain}},
                                 {colour::posterior}, {measure.title(), 0, std::max(high, 1e-3)})},
                 300)};
}

html::Figure curve_figure(const NextPlan& plan, const Measure& measure, const Varying& x) {
  std::map<int, std::map<double, double>> gains;
  for (std::size_t i = 0; i < plan.judged.size(); ++i) {
    double& gain = gains[plan.judged[i].candidate.specimens][x.value[i]];
    gain = std::max(gain, measure.value[i]);
  }
  std::vector<plot::Json> marks;
  std::size_t shade = 0;
  for (const auto& [specimens, by_x] : gains) {
    std::vector<double> at, gain;
    for (const auto& [value, of_value] : by_x) at.push_back(value), gain.push_back(of_value);
    const std::string label =
        gains.size() == 1 ? "" : fmt::format("{} specimen{}", specimens, specimens == 1 ? "" : "s");
    const plot::Look look{colour::chains[shade++ % 4], label};
    marks.push_back(at.size() > 1 ? plot::line({{"x", at}, {"y", gain}}, look)
                                  : plot::points({{"x", at}, {"y", gain}}, look));
  }
  return {"gain", fmt::format("Gain over {}", plain_name(x)),
          measure.of_what + "; where other conditions differ, that of the best.",
          plot::plot(fmt::format("{} against {}", measure.of_what, x.name),
                     {axis_title(x), by_ratio(x.levels)}, {measure.title(), false, 0.0},
                     std::move(marks), 280)};
}

}  // namespace

std::vector<html::Figure> next_figures(const NextPlan& plan) {
  std::vector<html::Figure> figures = {posterior_figure(plan)};
  const Measure measure = measure_of(plan);
  if (auto pareto = pareto_figure(plan, measure)) figures.push_back(std::move(*pareto));
  const std::vector<Varying> varying = varying_of(plan);
  int fewest = plan.judged.front().candidate.specimens;
  for (const Judged& each : plan.judged) fewest = std::min(fewest, each.candidate.specimens);
  if (!varying.empty()) figures.push_back(curve_figure(plan, measure, varying.front()));
  if (varying.size() >= 2)
    figures.push_back(map_figure(plan, measure, varying[0], varying.back(), fewest));
  return figures;
}

}  // namespace wearwell::plan
