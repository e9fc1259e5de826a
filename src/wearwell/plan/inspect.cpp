#include "wearwell/plan/inspect.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/plan/inspect_question.h"
#include "wearwell/prognosis/common_population.h"
#include "wearwell/prognosis/fleet_risk.h"
#include "wearwell/prognosis/information.h"
#include "wearwell/prognosis/inspection.h"

namespace wearwell::plan {
namespace {

using prognosis::KnownLives;
using prognosis::KnownUnit;
using prognosis::WeightedLives;

[[noreturn]] void refuse_stuck(const InspectReport& report, const UnitInspections& unit,
                               double after) {
  const Unit& axis = report.lives->unit;
  const std::string who = unit.name.empty()
                              ? fmt::format("a new {}", report.lives->noun)
                              : fmt::format("{} '{}'", report.lives->noun, printable(unit.name));
  if (report.aim == InspectAim::total_risk)
    throw InputError(fmt::format(
        "--total-risk: even inspections at all possible times leave more than {:.4g} % for {}; "
        "allow more, or give a smaller --step, an earlier --until or a longer --warning",
        100 * *report.total, who));
  if (report.step > 0)
    throw InputError(fmt::format(
        "--step: {:.4g} {} are too long for {}: after {:.4g} {} the risk until the next step is "
        "above {:.4g} %; give a smaller step or a larger --risk",
        report.step / axis.scale, axis.text, who, after / axis.scale, axis.text,
        100 * unit.bounds.risk));
  throw InputError(fmt::format(
      "--risk: {:.4g} % is less than the points of the life of {} resolve, after {:.4g} {}; give a "
      "larger risk or more points",
      100 * unit.bounds.risk, who, after / axis.scale, axis.text));
}

// The best plan of one unit alone.
InspectionTimes alone(const InspectReport& report, const LifeAhead& life,
                      const InspectionBounds& bounds) {
  if (report.aim == InspectAim::cheapest)
    return cheapest_inspections(life, bounds, report.prices).plan;
  if (report.aim == InspectAim::total_risk)
    return fewest_for_total(life, bounds, *report.total, *report.warning,
                            candidate_times(life, bounds));
  return fewest_inspections(life, bounds);
}

void plan_alone(InspectReport& report) {
  std::vector<InspectionTimes> plans(report.units.size());
  tbb::parallel_for(std::size_t{0}, plans.size(), [&](std::size_t u) {
    if (!report.units[u].past)
      plans[u] = alone(report, report.units[u].life, report.units[u].bounds);
  });
  for (std::size_t u = 0; u < plans.size(); ++u) {
    if (plans[u].stuck) refuse_stuck(report, report.units[u], *plans[u].stuck);
    report.units[u].times = std::move(plans[u].times);
  }
}

std::vector<double> together(const std::vector<UnitInspections>& units) {
  std::vector<double> all;
  for (const UnitInspections& each : units)
    all.insert(all.end(), each.times.begin(), each.times.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

// Joint visits: the fewest, or, if a visit costs something, the cheapest.
void plan_visits(InspectReport& report, const Monitor& monitor) {
  report.visits = together(report.units);
  report.alone_visits = report.visits.size();
  const bool priced = report.aim == InspectAim::cheapest && report.prices.visit > 0;
  if (!priced && report.aim != InspectAim::fewest) return;
  std::vector<LifeAhead> lives;
  std::vector<InspectionBounds> bounds;
  std::vector<UnitInspections*> running;
  for (UnitInspections& each : report.units) {
    if (each.past) continue;
    lives.push_back(each.life);
    bounds.push_back(each.bounds);
    running.push_back(&each);
  }
  std::vector<std::vector<double>> of_unit;
  if (priced) {
    report.joint = cheapest_visits(lives, bounds, report.prices,
                                   visit_candidates(lives, bounds, report.prices), monitor);
    report.visits = report.joint->visits;
    of_unit = report.joint->of_unit;
  } else {
    Visits fewest = fewest_visits(lives, bounds);
    if (fewest.visits.stuck)
      refuse_stuck(report, *running[fewest.stuck_unit], *fewest.visits.stuck);
    report.visits = std::move(fewest.visits.times);
    of_unit = std::move(fewest.of_unit);
  }
  for (std::size_t u = 0; u < running.size(); ++u) running[u]->times = of_unit[u];
}

void count_failures(InspectReport& report) {
  std::vector<const KnownUnit*> units;
  for (std::size_t u = 0; u < report.units.size(); ++u)
    if (!report.units[u].past) units.push_back(&report.lives->units[u]);
  if (report.visits.empty()) return;
  const prognosis::CommonPopulation common =
      prognosis::in_common(*report.lives, units, report.visits);
  for (std::size_t v = 0; v < report.visits.size(); ++v) {
    std::vector<std::vector<double>> failed;
    for (const auto& each : common.failed) failed.push_back(each[v]);
    const prognosis::Count count = prognosis::how_many(failed, common.weight);
    report.expected.push_back(prognosis::mean(count));
    report.any.push_back(1 - count[0]);
  }
  report.counted =
      common.why.empty()
          ? fmt::format(
                "Counts of units are averaged over {} possible populations that the units "
                "share (effective number {:.0f}).",
                common.weight.size(), common.effective)
          : fmt::format("Units are counted as independent, since {}.", common.why);
}

void add_costs(InspectReport& report) {
  if (report.aim != InspectAim::cheapest) return;
  const KnownLives& lives = *report.lives;
  const InspectionPrices& prices = report.prices;
  const prognosis::Costs costs{prices.failure, prices.replacement, prices.inspection};
  double of_decide = std::numeric_limits<double>::infinity();
  const auto ends = [](const WeightedLives& each) { return std::isfinite(each.points().back()); };
  if (!lives.fresh.lives.empty() &&
      std::all_of(lives.fresh.lives.begin(), lives.fresh.lives.end(), ends))
    of_decide =
        (prices.downtime ? prognosis::cheapest_hidden_interval(lives.fresh, costs, *prices.downtime)
                         : prognosis::cheapest_interval(lives.fresh, costs))
            .interval;
  InspectionPrices own = prices;
  if (report.fleet) own.visit = 0;  // shared: counted once for all
  for (UnitInspections& each : report.units) {
    if (each.past) continue;
    const double until = each.bounds.until;
    each.cost = cost_of(each.life, each.times, until, own);
    const EqualInterval equal = cheapest_equal(each.life, each.bounds, own);
    const auto named = [&](const char* name, const std::vector<double>& times) {
      return fmt::format("{}{}", name,
                         keeps_risk(each.life, times, each.bounds) ? "" : ", above the risk");
    };
    if (std::isfinite(equal.interval))
      each.others.push_back({"best equal interval", equal.interval, equal.cost});
    if (std::isfinite(of_decide) && of_decide < until)
      each.others.push_back(
          {named("equal interval of wearwell decide", equal_times(of_decide, until)), of_decide,
           cost_of(each.life, equal_times(of_decide, until), until, own)});
    each.others.push_back({named("no inspection", {}), 0, cost_of(each.life, {}, until, own)});
  }
}

double second_interval(const InspectReport& report, const UnitInspections& unit, double first,
                       const LifeAhead& after) {
  InspectionBounds bounds = unit.bounds;
  bounds.until -= first;
  if (report.aim == InspectAim::cheapest) {
    const CheapestTimes then = cheapest_inspections(after, bounds, report.prices);
    if (then.plan.stuck) return 0;
    return then.plan.times.empty() ? bounds.until : then.plan.times.front();
  }
  if (after.passed() > bounds.risk) return 0;
  const double latest = after.latest(bounds.risk);
  return bounds.step > 0 && std::isfinite(latest) ? bounds.step * std::floor(latest / bounds.step)
                                                  : latest;
}

// The next reading of one unit, before it is taken.
void add_next(const InspectQuestion& question, const prognosis::FollowedUnits& followed,
              InspectReport& report) {
  if (!followed.tracker || question.unit.empty()) {
    if (!question.given.empty())
      throw InputError("--given: describes the next reading of one unit of a result; give --unit");
    return;
  }
  const UnitInspections& unit = report.units[0];
  const auto measured = prognosis::measured_column(*followed.tracker);
  if (!measured || unit.times.empty() || report.aim == InspectAim::total_risk) return;
  const double first = unit.times[0];
  const auto state = followed.unit(unit.name);
  const prognosis::Forecast now = state->forecast();
  const prognosis::Reading reading =
      prognosis::next_reading(*followed.tracker, now.now + first, question.given);
  std::vector<prognosis::Outcome> outcomes;
  try {
    outcomes = prognosis::possible_outcomes(*followed.tracker, *state, reading, *measured,
                                            followed.history(unit.name));
  } catch (const InputError& error) {
    if (!question.given.empty()) throw;
    report.no_next = fmt::format("{}; give its conditions by --given", error.what());
    return;
  }
  const prognosis::ReadingColumn& column = followed.tracker->columns()[*measured];
  NextIntervals next{column.name,
                     column.unit,
                     first,
                     (unit.times.size() > 1 ? unit.times[1] : unit.bounds.until) - first,
                     std::vector<double>(outcomes.size()),
                     std::vector<double>(outcomes.size())};
  tbb::parallel_for(std::size_t{0}, outcomes.size(), [&](std::size_t i) {
    const prognosis::Outcome& each = outcomes[i];
    next.reading[i] = each.reading;
    const bool none = each.remaining.points().empty();
    next.interval[i] =
        none ? 0 : second_interval(report, unit, first, LifeAhead(each.passed, each.remaining));
  });
  report.next = std::move(next);
}

}  // namespace

Answer inspect(const InspectQuestion& question, const KnownLives& lives,
               const prognosis::FollowedUnits& followed, const Monitor& monitor) {
  InspectReport report = read_inspect_question(question, lives);
  plan_alone(report);
  if (report.fleet) {
    plan_visits(report, monitor);
    count_failures(report);
  }
  add_costs(report);
  add_next(question, followed, report);
  return inspect_answer(report);
}

}  // namespace wearwell::plan
