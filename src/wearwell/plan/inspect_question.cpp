#include "wearwell/plan/inspect_question.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/option_value.h"
#include "wearwell/prognosis/money.h"
#include "wearwell/prognosis/quantity_like.h"

namespace wearwell::plan {
namespace {

using prognosis::KnownLives;
using prognosis::KnownUnit;
using prognosis::WeightedLives;

// More likely than not the threshold is reached: there is nothing to plan.
constexpr double too_late = 0.5;
// A unit's plan ends where so few still run.
constexpr double hardly_any = 0.95;
constexpr double default_risk = 0.01;
constexpr double default_end = 0.5;
constexpr std::size_t most_steps = 5000;

double share_of(const char* option, const std::string& text) {
  const double share = option_value(option, text, "1", Allowed::positive);
  if (!(share < 1))
    throw InputError(
        fmt::format("{}: {} must lie between 0 and 1 (or 0 % and 100 %)", option, printable(text)));
  return share;
}

UnitInspections unit_plan(const KnownUnit& unit) {
  const bool none = unit.remaining.points().empty();
  return {unit.name,
          unit.now,
          LifeAhead(none ? 1 : unit.passed, unit.remaining),
          {},
          none || unit.passed >= too_late};
}

std::vector<UnitInspections> units_asked(const InspectQuestion& question, const KnownLives& lives) {
  if (question.fresh && !question.unit.empty())
    throw InputError("--new: is for a new unit; leave out --unit");
  std::vector<UnitInspections> units;
  if (question.fresh || lives.units.empty()) {
    if (!question.unit.empty())
      throw InputError(fmt::format("--unit: {} has no running units", printable(lives.title)));
    if (lives.fresh.lives.empty())
      throw InputError(fmt::format("{}: there is no life of a new {}", lives.title, lives.noun));
    units.push_back({"", 0, LifeAhead(0, lives.fresh.mixture()), {}});
    return units;
  }
  std::vector<std::string> names;
  for (const KnownUnit& each : lives.units) {
    names.push_back(each.name);
    if (question.unit.empty() || each.name == question.unit) units.push_back(unit_plan(each));
  }
  if (units.empty())
    throw InputError(fmt::format("--unit: there is no {} '{}'{}", lives.noun,
                                 printable(question.unit), did_you_mean(question.unit, names)));
  if (std::all_of(units.begin(), units.end(), [](const auto& each) { return each.past; }))
    throw InputError(
        units.size() == 1
            ? fmt::format("--unit: {} '{}' has more likely than not reached its threshold ({:.0f} "
                          "%): replace it or inspect it now",
                          lives.noun, printable(units[0].name), 100 * units[0].life.passed())
            : fmt::format("{}: every {} has more likely than not reached its threshold",
                          lives.title, lives.noun));
  return units;
}

// The time by which a share of the units has reached the threshold, on average.
double reached_by(const std::vector<UnitInspections>& units, double share) {
  double high = 0;
  std::size_t running = 0;
  for (const UnitInspections& each : units) {
    if (each.past) continue;
    ++running;
    const double late = each.life.latest(std::max(share, each.life.passed()));
    if (std::isfinite(late)) high = std::max(high, late);
  }
  const auto mean = [&](double time) {
    double sum = 0;
    for (const UnitInspections& each : units) sum += each.past ? 0 : each.life.reached(time);
    return sum / static_cast<double>(running);
  };
  if (mean(high) < share * (1 - 1e-9)) return std::numeric_limits<double>::infinity();
  double low = 0;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (mean(middle) < share ? low : high) = middle;
  }
  return high;
}

void read_prices(const InspectQuestion& question, InspectReport& report) {
  const KnownLives& lives = *report.lives;
  if (question.inspection_cost.empty() || question.failure_cost.empty())
    throw InputError(
        fmt::format("{}: costs go together: give --inspection-cost and --failure-cost",
                    question.inspection_cost.empty() ? "--inspection-cost" : "--failure-cost"));
  prognosis::Currency currency;
  InspectionPrices& prices = report.prices;
  prices.failure = prognosis::amount("--failure-cost", question.failure_cost, currency);
  prices.inspection = prognosis::amount("--inspection-cost", question.inspection_cost, currency);
  if (!(prices.inspection > 0))
    throw InputError("--inspection-cost: must be above 0; otherwise inspections never end");
  if (!question.visit_cost.empty())
    prices.visit = prognosis::amount("--visit-cost", question.visit_cost, currency);
  if (!question.downtime_cost.empty()) {
    if (!question.replacement_cost.empty())
      throw InputError(
          "--replacement-cost: with --downtime-cost failures are hidden until an inspection, so "
          "there is no preventive replacement; leave out one of the two");
    if (!question.warning.empty())
      throw InputError("--warning: with --downtime-cost an inspection shows only failures");
    prices.downtime =
        prognosis::amount_per("--downtime-cost", question.downtime_cost, lives.unit, currency);
  } else {
    if (question.replacement_cost.empty())
      throw InputError(
          "--replacement-cost: is missing: the cost of a preventive replacement; for failures that "
          "only an inspection shows give --downtime-cost instead");
    prices.replacement =
        prognosis::amount("--replacement-cost", question.replacement_cost, currency);
    if (!(prices.replacement > 0) || !(prices.replacement < prices.failure))
      throw InputError(fmt::format(
          "--replacement-cost: '{}' must be above 0 and below the cost of a failure; otherwise no "
          "inspection pays",
          printable(question.replacement_cost)));
    if (lives.fresh.lives.empty())
      throw InputError(
          fmt::format("{}: there is no life of a new {}, which values the use that an "
                      "early replacement loses; or give --downtime-cost",
                      lives.title, lives.noun));
    prices.use = prognosis::cheapest_age(lives.fresh, {prices.failure, prices.replacement, 0}).rate;
  }
  if (report.warning) prices.warning = *report.warning;
  report.currency = currency.text;
}

void read_aim(const InspectQuestion& question, InspectReport& report) {
  const Unit& axis = report.lives->unit;
  if (!question.risk.empty()) report.risk = share_of("--risk", question.risk);
  if (!question.warning.empty())
    report.warning =
        prognosis::quantity_like("--warning", question.warning, axis, Allowed::positive);
  const bool costs = !question.inspection_cost.empty() || !question.failure_cost.empty() ||
                     !question.replacement_cost.empty() || !question.downtime_cost.empty() ||
                     !question.visit_cost.empty();
  if (!question.total_risk.empty()) {
    if (costs)
      throw InputError("--total-risk: asks for the fewest inspections; leave out costs, or it");
    if (!report.warning)
      throw InputError(
          "--total-risk: needs --warning, the use before a failure within which an inspection "
          "shows that it comes; an inspection that shows only failures foresees none");
    report.total = share_of("--total-risk", question.total_risk);
    report.aim = InspectAim::total_risk;
  } else if (costs) {
    report.aim = InspectAim::cheapest;
    read_prices(question, report);
  } else {
    if (report.warning) throw InputError("--warning: needs --total-risk or costs");
    if (!report.risk) report.risk = default_risk;
  }
}

void read_range(const InspectQuestion& question, InspectReport& report) {
  const Unit& axis = report.lives->unit;
  report.until_given = !question.until.empty();
  report.until = report.until_given
                     ? prognosis::quantity_like("--until", question.until, axis, Allowed::positive)
                     : reached_by(report.units, default_end);
  if (!std::isfinite(report.until))
    throw InputError(
        "--until: is missing: fewer than half of these lives ever reach the threshold, so there is "
        "no default; give '5000 h'");
  if (!question.step.empty())
    report.step = prognosis::quantity_like("--step", question.step, axis, Allowed::positive);
  if (report.step > 0 && report.until / report.step > most_steps)
    throw InputError(fmt::format(
        "--step: '{}' divides the time until the end into {:.0f} steps, more than {}; give a "
        "larger step or an earlier --until",
        printable(question.step), report.until / report.step, most_steps));
  for (UnitInspections& each : report.units) {
    const double end = each.life.latest(std::max(hardly_any, each.life.passed()));
    each.shorter = end < report.until;
    each.bounds = {report.risk.value_or(1), std::min(report.until, end), report.step};
  }
}

}  // namespace

InspectReport read_inspect_question(const InspectQuestion& question, const KnownLives& lives) {
  InspectReport report;
  report.lives = &lives;
  report.units = units_asked(question, lives);
  report.fleet = question.unit.empty() && !report.units[0].name.empty();
  read_aim(question, report);
  read_range(question, report);
  return report;
}

}  // namespace wearwell::plan
