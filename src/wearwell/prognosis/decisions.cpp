#include "wearwell/prognosis/decisions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"

namespace wearwell::prognosis {
namespace {

// Its limit is more likely behind it than not: there is nothing to wait for.
constexpr double too_late = 0.5;

double failed_by(const KnownUnit& unit, double after) {
  if (unit.passed >= 1 || unit.remaining.points().empty()) return 1;
  return unit.passed + (1 - unit.passed) * unit.remaining.cdf(after);
}

UnitDecision decided(const KnownUnit& unit, const Costs& costs, double rate) {
  UnitDecision decision;
  decision.unit = &unit;
  if (unit.passed >= too_late || unit.remaining.points().empty()) {
    decision.best.now = decision.best.cost = costs.replacement;
  } else {
    decision.best = cheapest_moment(unit.remaining, costs, rate);
  }
  if (!unit.remaining.points().empty()) {
    decision.q05 = unit.remaining.quantile(0.05);
    decision.q50 = unit.remaining.quantile(0.50);
    decision.q95 = unit.remaining.quantile(0.95);
  }
  return decision;
}

FleetMonth month_of(const std::vector<UnitDecision>& units, const Question& question, int month) {
  FleetMonth result;
  result.month = month;
  result.until = month * *question.per_month;
  std::vector<double> reached, replaced;
  for (const UnitDecision& each : units) {
    const double failed = failed_by(*each.unit, result.until);
    reached.push_back(std::clamp(failed, 0.0, 1.0));
    replaced.push_back(each.best.after <= result.until ? 1 : reached.back());
  }
  result.reached = how_many(reached);
  result.replaced = how_many(replaced);
  result.low = enough_for(result.reached, 0.05);
  result.high = enough_for(result.reached, 0.95);
  result.parts = enough_for(result.reached, question.service);
  result.parts_planned = enough_for(result.replaced, question.service);
  return result;
}

}  // namespace

Decisions decide(const KnownLives& lives, const Question& question) {
  if (lives.fresh.lives.empty())
    throw InputError(fmt::format(
        "{}: nothing is said of the life of a new {}, against which running ones are held",
        lives.title, lives.noun));
  Decisions decisions;
  decisions.age = cheapest_age(lives.fresh, question.costs);
  decisions.reference = decisions.age->rate;
  if (question.hidden) {
    for (const WeightedLives& each : lives.fresh.lives) {
      if (!std::isfinite(each.points().back()))
        throw InputError(
            fmt::format("{}: some {}s never fail, so that a failure that nobody sees has no cost "
                        "in the long run; leave out the cost of downtime",
                        lives.title, lives.noun));
    }
    decisions.inspection = cheapest_hidden_interval(lives.fresh, question.costs, *question.hidden);
  } else if (question.inspected) {
    decisions.inspection = cheapest_interval(lives.fresh, question.costs);
  }
  for (const KnownUnit& each : lives.units)
    decisions.units.push_back(decided(each, question.costs, decisions.reference));
  std::stable_sort(decisions.units.begin(), decisions.units.end(),
                   [](const UnitDecision& a, const UnitDecision& b) {
                     if (a.best.after != b.best.after) return a.best.after < b.best.after;
                     return a.q50 < b.q50;
                   });
  if (question.per_month && !decisions.units.empty()) {
    for (int month = 1; month <= question.months; ++month)
      decisions.months.push_back(month_of(decisions.units, question, month));
  }
  return decisions;
}

}  // namespace wearwell::prognosis
