#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/plan/demonstration_result.h"
#include "wearwell/present/plot.h"

namespace wearwell::plan {
namespace {

using present::Table;
namespace colour = plot::colour;

std::string failures_text(std::size_t allowed) {
  return allowed == 0   ? "no failure"
         : allowed == 1 ? "at most 1 failure"
                        : fmt::format("at most {} failures", allowed);
}

const char* plan_colour(std::size_t i) {
  return colour::chains[i % 4];
}

std::string spread_column(const DemonstrationGoal& goal, double z, const std::string& what) {
  return fmt::format("{} at {} {:.4g}", what, goal.spread_name(), goal.spread->at(z));
}

// The sought number in units of the page.
double shown_sought(const Demonstration& result, double value) {
  return result.sought == Sought::time         ? result.goal.shown(value)
         : result.sought == Sought::confidence ? 100 * value
                                               : value;
}

present::Column sought_column(const Demonstration& result, const std::string& name) {
  if (result.sought == Sought::specimens) return {name, "1", present::given};
  if (result.sought == Sought::time) return {name, result.goal.goal.unit.text, present::life()};
  return {name, "%", present::digits(4)};
}

// Enough points for a smooth curve, evenly spaced in the logarithm.
std::vector<double> log_grid(double from, double to, int count) {
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back(from * std::pow(to / from, i / (count - 1.0)));
  return x;
}

double passing_share(const Demonstration& result, const DemonstrationPlan& plan,
                     const LifePoint& truth) {
  return pass_probability(plan.test, result.goal.scatter, truth.failing,
                          result.goal.spread ? truth.life / result.goal.goal.life : 1);
}

}  // namespace

Table plans_table(const Demonstration& result) {
  const DemonstrationGoal& goal = result.goal;
  const std::string unit = goal.goal.unit.text;
  const std::string passing =
      goal.spread ? fmt::format("90 % pass if {} is", b_life_name(goal.goal.failing))
                  : "90 % pass if reliability is";
  static constexpr const char* soughts[] = {"specimens", "time", "confidence"};
  const std::string sought = soughts[static_cast<int>(result.sought)];
  Table table{"plans",
              "Plans by the number of failures that are allowed",
              {{"failures", "1", present::given},
               {"specimens", "1", present::given},
               {"time each", unit, present::life()},
               {"confidence", "%", present::digits(4)},
               {passing, goal.spread ? unit : "%", present::digits(4)}}};
  const bool known = goal.spread && !goal.spread->uncertain && goal.weibull();
  const bool uncertain = goal.spread && goal.spread->uncertain;
  if (known) table.columns.push_back(sought_column(result, sought + " by exposure"));
  if (uncertain)
    for (const double z : {z05, z95})
      table.columns.push_back(sought_column(result, spread_column(goal, z, sought)));
  for (const DemonstrationPlan& plan : result.plans) {
    std::vector<present::Cell> row = {
        present::count(plan.test.allowed), present::count(plan.test.specimens),
        goal.shown(plan.test.time), 100 * plan.confidence,
        goal.spread ? goal.shown(plan.passing) : 100 * (1 - plan.passing)};
    const auto add = [&](const std::optional<double>& value) {
      row.emplace_back();
      if (value) row.back() = shown_sought(result, *value);
    };
    if (known) add(plan.by_exposure);
    if (uncertain) {
      add(plan.low);
      add(plan.high);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table pass_table(const Demonstration& result) {
  Table table{"probability-to-pass",
              "Probability to pass [%] with at most so many failures, by the true life",
              {{"true life"}}};
  for (const DemonstrationPlan& plan : result.plans)
    table.columns.push_back(
        {fmt::format("{} of {}", plan.test.allowed, plan.test.specimens), "1", present::digits(3)});
  for (const LifePoint& truth : true_lives(result.goal)) {
    std::vector<present::Cell> row = {truth.text};
    for (const DemonstrationPlan& plan : result.plans)
      row.emplace_back(100 * passing_share(result, plan, truth));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table sample_size_table(const Demonstration& result) {
  const std::string unit = result.goal.goal.unit.text;
  Table table{"sample-against-time",
              fmt::format("Time of each test [{}] by the number of specimens", unit),
              {{"specimens", "1", present::given}}};
  for (const DemonstrationPlan& plan : result.plans)
    table.columns.push_back({failures_text(plan.test.allowed), "1", present::life()});
  for (const SampleAgainstTime& each : result.sample_sizes) {
    std::vector<present::Cell> row = {present::count(each.specimens)};
    for (const auto& time : each.times) {
      row.emplace_back();
      if (time) row.back() = result.goal.shown(*time);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

namespace {

html::Figure confidence_by_specimens(const Demonstration& result) {
  const DemonstrationGoal& goal = result.goal;
  std::size_t most = 0;
  for (const DemonstrationPlan& plan : result.plans) most = std::max(most, plan.test.specimens);
  most = std::max<std::size_t>(10, most + most / 2);
  std::vector<plot::Json> marks;
  for (std::size_t i = 0; i < result.plans.size(); ++i) {
    const std::size_t allowed = result.plans[i].test.allowed;
    std::vector<double> x, y;
    const std::size_t step = std::max<std::size_t>(1, most / 400);
    for (std::size_t n = allowed + 1; n <= most; n += step) {
      x.push_back(present::count(n));
      y.push_back(100 * demonstrated_confidence({n, allowed, 1}, goal.scatter, goal.goal.failing));
    }
    marks.push_back(plot::line({{"x", x}, {"y", y}}, {plan_colour(i), failures_text(allowed)}));
    marks.push_back(plot::points({{"x", {present::count(result.plans[i].test.specimens)}},
                                  {"y", {100 * result.plans[i].confidence}}},
                                 {plan_colour(i)}));
  }
  marks.push_back(plot::horizontal_line(100 * goal.confidence,
                                        {colour::limit, "confidence to show", 1, 1.5, true}));
  return {"test-time", "Confidence by the number of specimens",
          "Confidence that a test shows if it passes, each specimen tested for the life to show.",
          plot::plot("Confidence against the number of specimens", {"Specimens", false, 0.0},
                     {"Confidence [%]", false, 0.0, 100.0}, std::move(marks), 300)};
}

}  // namespace

html::Figure sample_size_figure(const Demonstration& result) {
  const DemonstrationGoal& goal = result.goal;
  if (!goal.spread) return confidence_by_specimens(result);
  std::vector<plot::Json> marks;
  const auto curve = [&](std::size_t allowed, const Scatter& scatter, const plot::Look& look) {
    std::vector<double> x, y;
    for (std::size_t n = allowed + 1; n <= 200; n = std::max(n + 1, n * 11 / 10)) {
      const auto time = least_time(n, allowed, scatter, goal.goal.failing, goal.confidence);
      if (!time) continue;
      x.push_back(present::count(n));
      y.push_back(goal.shown(*time));
    }
    marks.push_back(plot::line({{"x", x}, {"y", y}}, look));
  };
  for (std::size_t i = 0; i < result.plans.size(); ++i) {
    const DemonstrationPlan& plan = result.plans[i];
    curve(plan.test.allowed, goal.scatter, {plan_colour(i), failures_text(plan.test.allowed)});
    if (i == 0 && goal.spread->uncertain) {
      for (const double z : {z05, z95})
        curve(plan.test.allowed, goal.scatter_at(z),
              {z < 0 ? colour::prior : colour::measured,
               fmt::format("{}, {} {:.3g}", failures_text(plan.test.allowed), goal.spread_name(),
                           goal.spread->at(z)),
               1, 1.5, true});
    }
    if (plan.test.specimens <= 200)
      marks.push_back(plot::points(
          {{"x", {present::count(plan.test.specimens)}}, {"y", {goal.shown(plan.test.time)}}},
          {plan_colour(i)}));
  }
  marks.push_back(
      plot::horizontal_line(goal.shown(1), {colour::limit, "life to show", 1, 1.5, true}));
  return {"test-time", "Sample size against test time",
          "Time of each test that shows the life with the confidence, by the number of specimens. "
          "Points are the plans of the table.",
          plot::plot("Time of each test against the number of specimens",
                     {"Specimens", true, 1.0, 200.0},
                     {fmt::format("Time of each test [{}]", html::unit(goal.goal.unit.text)), true},
                     std::move(marks), 300)};
}

html::Figure characteristic_figure(const Demonstration& result) {
  const DemonstrationGoal& goal = result.goal;
  std::vector<double> x;
  if (goal.spread) {
    double reach = 3;
    for (const DemonstrationPlan& plan : result.plans) reach = std::max(reach, 2 * plan.passing);
    for (const LifePoint& truth : goal.truth)
      reach = std::max(reach, 1.2 * truth.life / goal.goal.life);
    x = log_grid(0.5, std::min(reach, 1e6), 121);
  } else {
    for (int i = 0; i <= 120; ++i) x.push_back(std::min(1.0, 2.5 * goal.goal.failing) * i / 120);
  }
  std::vector<plot::Json> marks;
  for (std::size_t i = 0; i < result.plans.size(); ++i) {
    const DemonstrationPlan& plan = result.plans[i];
    std::vector<double> at, y;
    for (const double each : x) {
      at.push_back(goal.spread ? goal.shown(each) : 100 * (1 - each));
      y.push_back(100 * (goal.spread
                             ? pass_probability(plan.test, goal.scatter, goal.goal.failing, each)
                             : pass_probability(plan.test, goal.scatter, each)));
    }
    marks.push_back(plot::line(
        {{"x", at}, {"y", y}},
        {plan_colour(i), fmt::format("{} of {}", plan.test.allowed, plan.test.specimens)}));
  }
  marks.push_back(plot::vertical_line(goal.spread ? goal.shown(1) : 100 * (1 - goal.goal.failing),
                                      {colour::limit, "to show", 1, 1.5, true}));
  marks.push_back(plot::horizontal_line(100 * (1 - goal.confidence),
                                        {colour::prior, "consumer's risk", 1, 1.5, true}));
  const std::string name = b_life_name(goal.goal.failing);
  return {"characteristic", "Operating characteristic",
          "Probability to pass with at most so many failures. At the limit to show it is the "
          "consumer's risk, "
          "at most 1 - confidence; what it lacks to 100 % further right is the producer's risk.",
          plot::plot("Probability to pass against the true life",
                     goal.spread ? plot::Axis{fmt::format("True {} [{}]", name,
                                                          html::unit(goal.goal.unit.text)),
                                              true, goal.shown(x.front()), goal.shown(x.back())}
                                 : plot::Axis{"True reliability at the life to show [%]", false,
                                              100 * (1 - x.back()), 100.0},
                     {"Probability to pass [%]", false, 0.0, 100.0}, std::move(marks), 300)};
}

}  // namespace wearwell::plan
