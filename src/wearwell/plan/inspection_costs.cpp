#include "wearwell/plan/inspection_costs.h"

#include <algorithm>
#include <cmath>

#include "wearwell/prognosis/least.h"

namespace wearwell::plan {
namespace {

constexpr double dear = std::numeric_limits<double>::infinity();

void add(InspectionCost& sum, const InspectionCost& more) {
  sum.total += more.total;
  sum.inspections += more.inspections;
  sum.failing += more.failing;
  sum.replaced += more.replaced;
  sum.downtime += more.downtime;
  sum.lost += more.lost;
}

InspectionPlace start() {
  InspectionPlace place;
  place.time = not_inspected;
  return place;
}

bool bounded(const InspectionPlace& from, const InspectionPlace& to, double risk) {
  return to.reached <= 1 - (1 - risk) * (1 - from.reached) + 1e-12;
}

// Least cost from the start over any of the places to the end; the predecessors give the plan.
struct Cheapest {
  std::vector<double> least;
  std::vector<std::size_t> before;  // size of places: the start
};

Cheapest over_places(const std::vector<InspectionPlace>& places, double risk,
                     const InspectionPrices& prices) {
  const std::size_t n = places.size();
  Cheapest best{std::vector<double>(n, dear), std::vector<std::size_t>(n, n)};
  const InspectionPlace first = start();
  for (std::size_t j = 0; j < n; ++j) {
    if (bounded(first, places[j], risk))
      best.least[j] = between(first, places[j], true, prices).total;
    for (std::size_t i = 0; i < j; ++i) {
      if (!(best.least[i] < dear) || !bounded(places[i], places[j], risk)) continue;
      const double cost = best.least[i] + between(places[i], places[j], true, prices).total;
      if (cost < best.least[j]) best.least[j] = cost, best.before[j] = i;
    }
  }
  return best;
}

// Each time moved to the least between its neighbours.
void refine(const LifeAhead& life, const InspectionBounds& bounds, const InspectionPrices& prices,
            std::vector<double>& times) {
  constexpr int most_sweeps = 30;
  constexpr double small = 1e-9;
  double cost = cost_of(life, times, bounds.until, prices).total;
  for (int sweep = 0; sweep < most_sweeps && !times.empty(); ++sweep) {
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (times[k] == 0) continue;
      const bool last = k + 1 == times.size();
      const InspectionPlace before =
          k == 0 ? start() : inspection_place(life, prices, times[k - 1]);
      const double low = k == 0 ? 0 : times[k - 1], high = last ? bounds.until : times[k + 1];
      const InspectionPlace after = inspection_place(life, prices, high);
      const auto local = [&](double time) {
        const InspectionPlace here = inspection_place(life, prices, time);
        if (!bounded(before, here, bounds.risk) || !bounded(here, after, bounds.risk)) return dear;
        return between(before, here, true, prices).total +
               between(here, after, !last, prices).total;
      };
      std::vector<double> few;
      for (int i = 1; i < 8; ++i) few.push_back(low + (high - low) * i / 8);
      few.push_back(times[k]);
      std::sort(few.begin(), few.end());
      const prognosis::Least least = prognosis::least_of(local, few);
      if (least.value < local(times[k])) times[k] = least.at;
    }
    const double now = cost_of(life, times, bounds.until, prices).total;
    if (cost - now <= small * std::abs(cost)) break;
    cost = now;
  }
}

}  // namespace

InspectionPlace inspection_place(const LifeAhead& life, const InspectionPrices& prices,
                                 double time) {
  InspectionPlace place{time, life.reached(time), life.used(time)};
  if (prices.downtime) return place;
  const double end = time + prices.warning;
  place.shown = std::isfinite(end) ? life.reached(end) : 1;
  place.used_shown = std::isfinite(end) ? life.used(end) : 0;
  return place;
}

InspectionCost between(const InspectionPlace& from, const InspectionPlace& to, bool inspected_at_to,
                       const InspectionPrices& prices) {
  InspectionCost cost;
  const bool first = from.time == not_inspected;
  const double begin = first ? 0 : from.time;
  const double alive = 1 - from.reached;
  if (prices.downtime) {
    cost.failing = to.reached - from.reached;
    // The integral of F(x) - F(s): of all use that of survivors is left out.
    cost.downtime = (to.time - begin) * alive - (to.used - from.used);
    if (inspected_at_to) cost.inspections = alive;
    cost.total = prices.failure * cost.failing + *prices.downtime * cost.downtime +
                 prices.inspection * cost.inspections;
  } else {
    if (!first) {
      const bool all = from.time + prices.warning >= to.time;
      const double until = all ? to.time : from.time + prices.warning;
      const double shown = all ? to.reached : from.shown;
      const double used = all ? to.used : from.used_shown;
      cost.inspections = alive;
      cost.replaced = shown - from.reached;
      cost.lost = (until - from.time) * alive - (used - from.used);
      // Use beyond the end of life is not lost: of the integral of F - F(s), what follows it is taken off.
      cost.lost = (until - from.time) * cost.replaced - cost.lost;
    }
    cost.failing = to.reached - from.reached - cost.replaced;
    cost.total = prices.failure * cost.failing + prices.replacement * cost.replaced +
                 prices.inspection * cost.inspections + prices.use * cost.lost;
  }
  if (inspected_at_to) cost.total += prices.visit;
  return cost;
}

InspectionCost cost_of(const LifeAhead& life, std::span<const double> times, double until,
                       const InspectionPrices& prices) {
  InspectionCost sum;
  InspectionPlace from = start();
  for (std::size_t k = 0; k <= times.size(); ++k) {
    const bool inspected = k < times.size();
    const InspectionPlace to = inspection_place(life, prices, inspected ? times[k] : until);
    add(sum, between(from, to, inspected, prices));
    from = to;
  }
  return sum;
}

CheapestTimes cheapest_inspections(const LifeAhead& life, const InspectionBounds& bounds,
                                   const InspectionPrices& prices) {
  const std::vector<double> candidates = candidate_times(life, bounds);
  std::vector<InspectionPlace> places;
  for (const double each : candidates) places.push_back(inspection_place(life, prices, each));
  const InspectionPlace end = inspection_place(life, prices, bounds.until);
  const Cheapest best = over_places(places, bounds.risk, prices);
  const std::size_t n = places.size();
  std::size_t last = n;
  double least =
      bounded(start(), end, bounds.risk) ? between(start(), end, false, prices).total : dear;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(best.least[i] < dear) || !bounded(places[i], end, bounds.risk)) continue;
    const double cost = best.least[i] + between(places[i], end, false, prices).total;
    if (cost < least) least = cost, last = i;
  }
  CheapestTimes cheapest;
  if (!(least < dear)) {
    cheapest.plan.stuck = 0;
    return cheapest;
  }
  for (std::vector<double>& times = cheapest.plan.times; last != n; last = best.before[last])
    times.insert(times.begin(), candidates[last]);
  if (!(bounds.step > 0)) refine(life, bounds, prices, cheapest.plan.times);
  cheapest.cost = cost_of(life, cheapest.plan.times, bounds.until, prices);
  return cheapest;
}

std::vector<double> equal_times(double interval, double until) {
  std::vector<double> times;
  for (std::size_t k = 1; static_cast<double>(k) * interval < until * (1 - 1e-9); ++k)
    times.push_back(static_cast<double>(k) * interval);
  return times;
}

bool keeps_risk(const LifeAhead& life, std::span<const double> times,
                const InspectionBounds& bounds) {
  const std::vector<double> risks = risks_between(life, times, bounds.until);
  return *std::max_element(risks.begin(), risks.end()) <= bounds.risk + 1e-9;
}

EqualInterval cheapest_equal(const LifeAhead& life, const InspectionBounds& bounds,
                             const InspectionPrices& prices) {
  EqualInterval best{dear, cost_of(life, {}, bounds.until, prices)};
  if (!keeps_risk(life, {}, bounds)) best.cost.total = dear;
  const auto consider = [&](double interval) {
    const std::vector<double> times = equal_times(interval, bounds.until);
    const InspectionCost cost = cost_of(life, times, bounds.until, prices);
    if (cost.total < best.cost.total && keeps_risk(life, times, bounds)) best = {interval, cost};
  };
  constexpr int most = 300;
  if (bounds.step > 0) {
    const double multiples = bounds.until / bounds.step;
    const double skip = std::max(1.0, std::ceil(multiples / most));
    for (double k = 1; k < multiples; k += skip) consider(k * bounds.step);
  } else {
    for (int i = 1; i <= most; ++i)  // from a two hundredth of the horizon on
      consider(bounds.until * std::pow(200.0, static_cast<double>(i) / most - 1));
  }
  return best;
}

}  // namespace wearwell::plan
