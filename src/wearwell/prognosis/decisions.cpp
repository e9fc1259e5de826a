#include "wearwell/prognosis/decisions.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/prognosis/plural.h"

namespace wearwell::prognosis {
namespace {

// The unit has more likely than not reached its threshold: there is no reason to wait.
constexpr double too_late = 0.5;

// The lives that remain to a unit in service, with the weights of populations given its survival.
PopulationLives remaining_of(const KnownUnit& unit, const std::vector<double>& populations) {
  InPopulations in = unit.in_populations().value();
  std::vector<double> weight;
  for (std::size_t k = 0; k < populations.size(); ++k)
    weight.push_back(populations[k] * std::exp(in.log_likelihood[k]));
  return {std::move(in.remaining), std::move(weight)};
}

UnitDecision decided(const KnownUnit& unit, const KnownLives& lives, const Costs& costs,
                     const AgeReplacement& age) {
  UnitDecision decision;
  decision.unit = &unit;
  const bool by_age = unit.by_age && !age.beyond_known;
  decision.past_optimum = by_age && unit.now >= age.age;
  if (unit.passed >= too_late || unit.remaining.points().empty()) {
    decision.best.now = decision.best.cost = costs.replacement;
  } else if (by_age) {
    decision.best = replacement_by_age(lives.fresh, remaining_of(unit, lives.populations), costs,
                                       unit.now, age.age);
  } else {
    decision.best = cheapest_moment(unit.remaining, costs, age.rate);
  }
  if (!unit.remaining.points().empty()) {
    decision.q05 = unit.remaining.quantile(0.05);
    decision.q50 = unit.remaining.quantile(0.50);
    decision.q95 = unit.remaining.quantile(0.95);
  }
  return decision;
}

// Number of months whose probabilities are in memory at once, for each population and unit.
std::size_t months_at_once(std::size_t populations, std::size_t units) {
  constexpr std::size_t most_numbers = 20'000'000;
  return std::max<std::size_t>(1, most_numbers / std::max<std::size_t>(1, populations * units));
}

FleetMonth month_of(const std::vector<UnitDecision>& units, const Question& question, int month,
                    const CommonPopulation& common, std::size_t moment) {
  FleetMonth result;
  result.month = month;
  result.until = month * *question.per_month;
  std::vector<std::vector<double>> reached, replaced;
  for (const auto& failed : common.failed) {
    reached.push_back(failed[moment]);
    replaced.push_back(failed[moment]);
    for (std::size_t u = 0; u < units.size(); ++u)
      if (units[u].best.after <= result.until) replaced.back()[u] = 1;
  }
  result.reached = how_many(reached, common.weight);
  result.replaced = how_many(replaced, common.weight);
  result.low = enough_for(result.reached, 0.05);
  result.high = enough_for(result.reached, 0.95);
  result.parts = enough_for(result.reached, question.service);
  result.parts_planned = enough_for(result.replaced, question.service);
  return result;
}

void count_months(const KnownLives& lives, const Question& question, Decisions& decisions) {
  std::vector<const KnownUnit*> units;
  for (const UnitDecision& each : decisions.units) units.push_back(each.unit);
  const auto months = static_cast<std::size_t>(question.months);
  const std::size_t step = months_at_once(lives.populations.size(), units.size());
  for (std::size_t first = 0; first < months; first += step) {
    std::vector<double> after;
    for (std::size_t m = first; m < std::min(first + step, months); ++m)
      after.push_back(static_cast<double>(m + 1) * *question.per_month);
    const CommonPopulation common = in_common(lives, units, after);
    const std::size_t populations = common.why.empty() ? common.weight.size() : 0;
    decisions.counting = {populations, common.effective, common.why, common.outgrown};
    const std::size_t before = decisions.months.size();
    decisions.months.resize(before + after.size());
    tbb::parallel_for(std::size_t{0}, after.size(), [&](std::size_t m) {
      decisions.months[before + m] =
          month_of(decisions.units, question, static_cast<int>(first + m) + 1, common, m);
    });
  }
}

}  // namespace

Decisions decide(const KnownLives& lives, const Question& question) {
  if (lives.fresh.lives.empty())
    throw InputError(
        fmt::format("{}: the study has no life of a new {}, which decisions on running ones need",
                    lives.title, lives.noun));
  Decisions decisions;
  decisions.age = cheapest_age(lives.fresh, question.costs);
  if (!lives.fewer.lives.empty())
    estimate_errors(*decisions.age, cheapest_age(lives.fewer, question.costs));
  decisions.reference = decisions.age->rate;
  if (question.claims) decisions.warranty = longest_warranty(lives, *question.claims);
  if (question.hidden || question.inspected) {
    for (const WeightedLives& each : lives.fresh.lives) {
      if (!each.points().empty() && !std::isfinite(each.points().back()))
        throw InputError(fmt::format(
            "{}: some {} never fail, so {} has no long-run cost; leave out the cost of {}",
            lives.title, plural(lives.noun),
            question.hidden ? "an undetected failure" : "inspection until failure",
            question.hidden ? "downtime" : "an inspection"));
    }
  }
  if (question.hidden) {
    decisions.inspection = cheapest_hidden_interval(lives.fresh, question.costs, *question.hidden);
  } else if (question.inspected) {
    decisions.inspection = cheapest_interval(lives.fresh, question.costs);
  }
  for (const KnownUnit& each : lives.units)
    decisions.units.push_back(decided(each, lives, question.costs, *decisions.age));
  std::stable_sort(decisions.units.begin(), decisions.units.end(),
                   [](const UnitDecision& a, const UnitDecision& b) {
                     if (a.best.after != b.best.after) return a.best.after < b.best.after;
                     return a.q50 < b.q50;
                   });
  if (question.per_month && !decisions.units.empty()) count_months(lives, question, decisions);
  return decisions;
}

}  // namespace wearwell::prognosis
