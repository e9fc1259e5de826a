#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/plan/inspect_report.h"
#include "wearwell/present/plot.h"
#include "wearwell/prognosis/plural.h"

namespace wearwell::plan {
namespace {

namespace colour = plot::colour;

double in_axis(const InspectReport& report, double si) {
  return si / report.lives->unit.scale;
}

std::string axis_heading(const InspectReport& report, const char* what) {
  return fmt::format("{} [{}]", what, html::unit(report.lives->unit.text));
}

// Times at which curves are drawn, with both sides of every inspection.
std::vector<double> curve_times(const UnitInspections& unit) {
  std::vector<double> times;
  constexpr int count = 240;
  for (int i = 0; i <= count; ++i) times.push_back(unit.bounds.until * i / count);
  times.insert(times.end(), unit.times.begin(), unit.times.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace

present::Table inspections_table(const InspectReport& report, const UnitInspections& unit) {
  const std::string& axis = report.lives->unit.text;
  present::Table table{"inspections",
                       "Inspections ahead",
                       {{"inspection"},
                        {"from now", axis},
                        {report.lives->axis, axis},
                        {"interval", axis},
                        {"risk in it", "%", present::digits(3)},
                        {"threshold reached by then", "%", present::digits(3)}}};
  const std::vector<double> risks = risks_between(unit.life, unit.times, unit.bounds.until);
  const bool placed = std::isfinite(unit.now) && unit.now > 0;
  for (std::size_t k = 0; k <= unit.times.size(); ++k) {
    const bool end = k == unit.times.size();
    const double time = end ? unit.bounds.until : unit.times[k];
    const double before = k == 0 ? 0 : unit.times[k - 1];
    table.rows.push_back(
        {end ? std::string("end") : fmt::format("{}", k + 1), in_axis(report, time),
         placed ? present::Cell(in_axis(report, unit.now + time)) : present::Cell(),
         in_axis(report, time - before), 100 * risks[k], 100 * unit.life.reached(time)});
  }
  if (!placed) {
    table.columns.erase(table.columns.begin() + 2);
    for (auto& row : table.rows) row.erase(row.begin() + 2);
  }
  return table;
}

present::Table costs_table(const InspectReport& report, const UnitInspections& unit) {
  const std::string money = report.currency.empty() ? "1" : report.currency;
  const bool hidden = report.prices.downtime.has_value();
  const std::string& axis = report.lives->unit.text;
  present::Table table{"costs",
                       "Expected until the end of the plan",
                       {{"inspections at"},
                        {"every", axis},
                        {"inspections", "1", present::digits(3)},
                        {"fails in service", "%", present::digits(3)},
                        {hidden ? "use after failure" : "use lost", axis, present::digits(3)},
                        {"cost", money}}};
  const auto add = [&](const std::string& name, double interval, const InspectionCost& cost) {
    table.rows.push_back({name,
                          interval > 0 ? present::Cell(in_axis(report, interval)) : present::Cell(),
                          cost.inspections, 100 * cost.failing,
                          in_axis(report, hidden ? cost.downtime : cost.lost), cost.total});
  };
  add("planned times", 0, *unit.cost);
  for (const OtherPlan& each : unit.others) add(each.name, each.interval, each.cost);
  return table;
}

present::Table inspected_units_table(const InspectReport& report) {
  const std::string& axis = report.lives->unit.text;
  present::Table table{"units",
                       fmt::format("Each {}, next inspection first", report.lives->noun),
                       {{report.lives->noun},
                        {"next inspection", axis},
                        {"inspections", "1", present::given},
                        {"highest risk between", "%", present::digits(3)},
                        {"RUL, 5 %", axis, present::life()},
                        {"50 %", axis, present::life()},
                        {"plan ends", axis},
                        {"cost", report.currency.empty() ? "1" : report.currency}}};
  std::vector<const UnitInspections*> order;
  for (const UnitInspections& each : report.units) order.push_back(&each);
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
    const auto first = [](const UnitInspections& unit) {
      return unit.past ? -1 : unit.times.empty() ? infinity : unit.times[0];
    };
    return first(*a) < first(*b);
  });
  for (const UnitInspections* each : order) {
    if (each->past) {
      table.rows.push_back({each->name, std::string("past threshold"), {}, {}, {}, {}, {}, {}});
      continue;
    }
    const std::vector<double> risks = risks_between(each->life, each->times, each->bounds.until);
    const auto quantile = [&](double p) {
      return in_axis(report, each->life.latest(std::max(p, each->life.passed())));
    };
    table.rows.push_back({each->name,
                          each->times.empty() ? present::Cell(std::string("none"))
                                              : present::Cell(in_axis(report, each->times[0])),
                          present::count(each->times.size()),
                          100 * *std::max_element(risks.begin(), risks.end()), quantile(0.05),
                          quantile(0.5), in_axis(report, each->bounds.until),
                          each->cost ? present::Cell(each->cost->total) : present::Cell()});
  }
  if (report.aim != InspectAim::cheapest) {
    table.columns.pop_back();
    for (auto& row : table.rows) row.pop_back();
  }
  return table;
}

present::Table visits_table(const InspectReport& report) {
  const std::string& axis = report.lives->unit.text;
  present::Table table{"visits",
                       "Visits ahead",
                       {{"visit"},
                        {"from now", axis},
                        {"inspects", "1", present::given},
                        {prognosis::plural(report.lives->noun)},
                        {"reach the threshold by then", "1", present::digits(3)},
                        {"at least one", "%", present::digits(3)}}};
  for (std::size_t v = 0; v < report.visits.size(); ++v) {
    std::string names;
    std::size_t count = 0;
    for (const UnitInspections& each : report.units) {
      if (!std::binary_search(each.times.begin(), each.times.end(), report.visits[v])) continue;
      names += (count++ == 0 ? "" : ", ") + each.name;
    }
    table.rows.push_back({fmt::format("{}", v + 1), in_axis(report, report.visits[v]),
                          present::count(count), names, report.expected[v], 100 * report.any[v]});
  }
  return table;
}

html::Figure interval_risk_figure(const InspectReport& report, const UnitInspections& unit) {
  std::vector<double> x, y, at, risk;
  const std::vector<double> risks = risks_between(unit.life, unit.times, unit.bounds.until);
  double since = 0;
  std::size_t k = 0;
  for (const double time : curve_times(unit)) {
    const auto now = [&] { return 100 * (unit.life.reached(time) - since) / (1 - since); };
    x.push_back(in_axis(report, time));
    y.push_back(now());
    if (k == unit.times.size() || time != unit.times[k]) continue;
    at.push_back(x.back());
    risk.push_back(100 * risks[k++]);
    since = unit.life.reached(time);
    x.push_back(x.back());
    y.push_back(0);
  }
  std::vector<plot::Json> marks = {plot::line({{"x", x}, {"y", y}}, {colour::posterior})};
  if (!at.empty())
    marks.push_back(plot::points({{"x", at}, {"y", risk}}, {colour::measured, "inspection"}));
  if (report.risk)
    marks.push_back(plot::horizontal_line(100 * *report.risk,
                                          {colour::limit, "largest risk allowed", 1, 1.5, true}));
  return {
      "risk", "Risk between inspections",
      "Probability that the threshold is reached since the last inspection, given that it "
      "found the unit running.",
      plot::plot("Risk since the last inspection against use from now on",
                 {axis_heading(report, "From now"), false, 0.0},
                 {"Risk since the last inspection [%]", false, 0.0}, std::move(marks), 280, true)};
}

html::Figure reached_figure(const InspectReport& report, const UnitInspections& unit) {
  std::vector<double> x, y, at, reached;
  for (const double time : curve_times(unit)) {
    x.push_back(in_axis(report, time));
    y.push_back(100 * unit.life.reached(time));
  }
  for (const double time : unit.times) {
    at.push_back(in_axis(report, time));
    reached.push_back(100 * unit.life.reached(time));
  }
  std::vector<plot::Json> marks = {plot::line({{"x", x}, {"y", y}}, {colour::posterior})};
  if (!at.empty())
    marks.push_back(plot::points({{"x", at}, {"y", reached}}, {colour::measured, "inspection"}));
  return {"reached", "Threshold reached",
          "Probability that the threshold is reached by then, without any replacement.",
          plot::plot("Probability that the threshold is reached against use from now on",
                     {axis_heading(report, "From now"), false, 0.0},
                     {"Threshold reached [%]", false, 0.0}, std::move(marks), 280, true)};
}

html::Figure visits_figure(const InspectReport& report) {
  constexpr std::size_t most = 40;  // names that an axis holds
  std::vector<double> x, y;
  plot::Axis units{html::capital(report.lives->noun)};
  for (const UnitInspections& each : report.units) {
    if (each.past || units.names.size() == most) continue;
    units.names.push_back(each.name);
    for (const double time : each.times) {
      x.push_back(in_axis(report, time));
      y.push_back(static_cast<double>(units.names.size()));
    }
  }
  units.low = 0.5;
  units.high = static_cast<double>(units.names.size()) + 0.5;
  std::vector<plot::Json> marks;
  std::vector<double> at, low, high;
  for (const double visit : report.visits) {
    at.push_back(in_axis(report, visit));
    low.push_back(*units.low);
    high.push_back(*units.high);
  }
  if (!at.empty()) {
    marks.push_back(
        plot::ranges({{"x", at}, {"y", high}, {"y2", low}}, {colour::prior, "visit", 0.5, 1}));
    marks.push_back(plot::points({{"x", x}, {"y", y}}, {colour::measured, "inspection"}));
  }
  const std::string shown =
      report.units.size() > most
          ? fmt::format(" The first {} {}.", most, prognosis::plural(report.lives->noun))
          : "";
  return {"visits",
          "Visits ahead",
          fmt::format("Which {} are inspected at which visit.{}",
                      prognosis::plural(report.lives->noun), shown),
          plot::plot("Inspections of each unit against use from now on",
                     {axis_heading(report, "From now"), false, 0.0, in_axis(report, report.until)},
                     units, std::move(marks),
                     static_cast<int>(120 + 22 * std::min(most, report.units.size()))),
          {},
          true};
}

html::Figure next_figure(const InspectReport& report) {
  const NextIntervals& next = *report.next;
  std::vector<double> interval = next.interval, share;
  std::sort(interval.begin(), interval.end());
  for (std::size_t i = 0; i < interval.size(); ++i) {
    share.push_back(100 * (static_cast<double>(i) + 0.5) / static_cast<double>(interval.size()));
    interval[i] = in_axis(report, interval[i]);
  }
  std::erase_if(interval, [](double x) { return !std::isfinite(x); });
  share.resize(interval.size());
  std::vector<plot::Json> marks = {
      plot::line({{"x", interval}, {"y", share}}, {colour::posterior, "after the reading"})};
  marks.push_back(plot::vertical_line(in_axis(report, next.planned),
                                      {colour::prior, "by present knowledge", 1, 1.5, true}));
  return {"next", "Interval after the first reading",
          "Share of possible readings after which the second inspection comes earlier than this.",
          plot::plot("Cumulative share of outcomes against the second interval",
                     {axis_heading(report, "Second interval"), false, 0.0},
                     {"Share of outcomes [%]", false, 0.0, 100.0}, std::move(marks))};
}

}  // namespace wearwell::plan
