#include "wearwell/prognosis/decisions_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/present/plot.h"
#include "wearwell/prognosis/plural.h"

namespace wearwell::prognosis {
namespace {

using present::Table;
namespace colour = plot::colour;

const char* inspected_how(const DecisionsReport& report) {
  return report.question.hidden ? "inspected, failures hidden" : "inspected, wear fully observed";
}

}  // namespace

// Of the policies: the same for all units.
Table policies_table(const DecisionsReport& report) {
  const Shown shown{report};
  const Decisions& decisions = report.decisions;
  Table table{"policies",
              fmt::format("All {} alike, in the long run", plural(report.lives.noun)),
              {{"policy"},
               {"every", shown.unit(), present::life()},
               {"cost", shown.rate_unit()},
               {"fail in service", "%", present::digits(3)},
               {"within 1 %", shown.unit(), {}, true}}};
  const AgeReplacement& age = *decisions.age;
  const auto ages = [&](double from, double to) -> present::Cell {
    return present::Range{shown.at(from), shown.at(to)};
  };
  const auto add = [&](const char* name, double every, double rate, double failing,
                       const present::Cell& as_good) {
    std::vector<present::Cell> row(5);
    row[0] = std::string(name);
    if (std::isfinite(every)) row[1] = shown.at(every);
    row[2] = shown.rate(rate);
    row[3] = 100 * failing;
    row[4] = as_good;
    table.rows.push_back(std::move(row));
  };
  add("replaced at failure only", std::numeric_limits<double>::infinity(), age.at_failure, 1, {});
  if (std::isfinite(age.age))
    add("replaced by age", age.age, age.rate, age.failing, ages(age.from, age.to));
  if (decisions.inspection && std::isfinite(decisions.inspection->interval)) {
    const InspectionInterval& best = *decisions.inspection;
    add(inspected_how(report), best.interval, best.rate, best.failing, ages(best.from, best.to));
  }
  return table;
}

Table units_table(const DecisionsReport& report) {
  const Shown shown{report};
  const std::string unit = shown.unit();
  Table table{"units",
              fmt::format("Each {} now, most urgent first", report.lives.noun),
              {{report.lives.noun},
               {report.lives.axis, unit},
               {"RUL, 5 %", unit, present::life()},
               {"50 %", unit, present::life()},
               {"95 %", unit, present::life()},
               {"past threshold", "%", present::digits(3)},
               {"replace after", unit, present::life()},
               {"fails before", "%", present::digits(3)},
               {"waiting saves", report.question.currency.empty() ? "1" : report.question.currency,
                present::digits(3)}}};
  for (const UnitDecision& each : report.decisions.units) {
    const double at = each.unit->now;
    table.rows.push_back(
        {each.unit->name, std::isnan(at) ? present::Cell{} : present::Cell{shown.at(at)},
         shown.at(each.q05), shown.at(each.q50), shown.at(each.q95),
         each.unit->passed < 1e-9 ? 0 : 100 * each.unit->passed, shown.at(each.best.after),
         100 * each.best.failing, each.best.now - each.best.cost});
  }
  if (std::all_of(table.rows.begin(), table.rows.end(),
                  [](const auto& row) { return std::holds_alternative<std::monostate>(row[1]); })) {
    table.columns.erase(table.columns.begin() + 1);
    for (auto& row : table.rows) row.erase(row.begin() + 1);
  }
  return table;
}

Table months_table(const DecisionsReport& report) {
  const Shown shown{report};
  const std::string level = fmt::format("{:.4g} %", 100 * report.question.service);
  Table table{"fleet",
              fmt::format("Numbers of {} {}, from now until the end of each month",
                          report.lives.units.size(), plural(report.lives.noun)),
              {{"month", "1", present::given},
               {"use by then", shown.unit()},
               {"reach the threshold", "1", present::digits(3)},
               {"5 to 95 %", "1", present::given, true},
               {"spare parts, " + level, "1", present::given},
               {"spare parts if replaced in time, " + level, "1", present::given}}};
  for (const FleetMonth& each : report.decisions.months)
    table.rows.push_back({static_cast<double>(each.month), shown.at(each.until), mean(each.reached),
                          present::Range{present::count(each.low), present::count(each.high)},
                          present::count(each.parts), present::count(each.parts_planned)});
  return table;
}

CostCurve cost_curve(const DecisionsReport& report) {
  const Shown shown{report};
  const PopulationLives& fresh = report.lives.fresh;
  const AgeReplacement& age = *report.decisions.age;
  CostCurve curve;
  const double reach = std::max(age.rate * 6, age.at_failure * 1.5);
  double last = 0;
  for (const double each : ages_of(fresh.lives, 150)) {
    const double rate = cost_rate(fresh, report.question.costs, each);
    if (rate > reach) continue;
    curve.age.push_back(shown.at(each));
    curve.cost.push_back(shown.rate(rate));
    if (std::abs(rate - age.at_failure) > 0.01 * age.at_failure) last = curve.age.back();
  }
  if (last > 0) curve.end = 1.3 * last;
  return curve;
}

html::Figure cost_figure(const DecisionsReport& report) {
  const Shown shown{report};
  const AgeReplacement& age = *report.decisions.age;
  const CostCurve curve = cost_curve(report);
  std::vector<plot::Json> marks = {
      plot::line({{"x", curve.age}, {"y", curve.cost}}, {colour::posterior})};
  if (std::isfinite(age.age))
    marks.push_back(plot::vertical_line(shown.at(age.age), {colour::limit, "least", 1, 1.5, true}));
  if (age.at_failure > 0)
    marks.push_back(plot::horizontal_line(
        shown.rate(age.at_failure), {colour::prior, "replaced at failure only", 1, 1.5, true}));
  return {
      "cost", "Cost of replacement by age",
      "Long-run cost against the age of replacement, averaged over the uncertainty of the "
      "population.",
      plot::plot("Cost per unit of use against the age of replacement",
                 {fmt::format("Replaced at [{}]", html::unit(shown.unit())), false, 0.0, curve.end},
                 {fmt::format("Cost [{}]", html::unit(shown.rate_unit())), false, 0.0},
                 std::move(marks), 300, true)};
}

// Whole months, a dozen ticks at most.
plot::Axis month_axis(std::size_t months) {
  constexpr std::size_t most = 12;
  const std::size_t step = (months + most - 1) / most;
  plot::Axis axis{"Month"};
  for (std::size_t i = step; i <= months; i += step)
    axis.ticks.emplace_back(static_cast<double>(i), fmt::format("{}", i));
  return axis;
}

html::Figure months_figure(const DecisionsReport& report) {
  std::vector<double> month, low, high, middle, parts;
  for (const FleetMonth& each : report.decisions.months) {
    month.push_back(each.month);
    low.push_back(static_cast<double>(each.low));
    high.push_back(static_cast<double>(each.high));
    middle.push_back(mean(each.reached));
    parts.push_back(static_cast<double>(each.parts_planned));
  }
  return {"months", "Units that reach their failure threshold",
          "Expected number with its 90 % interval, if none is replaced before; and the number of "
          "spare parts that suffices if each is replaced in time.",
          plot::plot("Units that reach their failure threshold against months",
                     month_axis(report.decisions.months.size()),
                     {html::capital(plural(report.lives.noun)), false, 0.0},
                     {plot::area({{"x", month}, {"y", high}, {"y2", low}},
                                 {colour::posterior, "90 % interval", 0.25}),
                      plot::line({{"x", month}, {"y", middle}}, {colour::posterior, "expected"}),
                      plot::steps({{"x", month}, {"y", parts}},
                                  {colour::measured, "spare parts, replaced in time"})},
                     300)};
}

}  // namespace wearwell::prognosis
