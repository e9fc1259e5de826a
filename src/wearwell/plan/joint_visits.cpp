#include "wearwell/plan/joint_visits.h"
#include "wearwell/base/progress.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace wearwell::plan {
namespace {

constexpr double out_of_reach = std::numeric_limits<double>::infinity();

// One unit's places at all candidates.
struct UnitPlaces {
  std::vector<InspectionPlace> at;
  InspectionPlace end;
  double risk = 1;
};

struct BestOfUnit {
  double cost = out_of_reach;
  std::vector<std::size_t> chosen = {};
};

bool within(const InspectionPlace& from, const InspectionPlace& to, double risk) {
  return to.reached <= 1 - (1 - risk) * (1 - from.reached) + 1e-12;
}

// The least cost of one unit if it can be inspected at these candidates only.
BestOfUnit best_of_unit(const UnitPlaces& unit, const std::vector<std::size_t>& visits,
                        const InspectionPrices& prices) {
  std::vector<std::size_t> open;
  for (const std::size_t each : visits)
    if (unit.at[each].time < unit.end.time) open.push_back(each);
  const std::size_t n = open.size();
  InspectionPlace first;
  first.time = not_inspected;
  std::vector<double> least(n, out_of_reach);
  std::vector<std::size_t> before(n, n);
  for (std::size_t j = 0; j < n; ++j) {
    const InspectionPlace& to = unit.at[open[j]];
    if (within(first, to, unit.risk)) least[j] = between(first, to, true, prices).total;
    for (std::size_t i = j; i-- > 0;) {
      if (!within(unit.at[open[i]], to, unit.risk)) break;  // earlier ones are farther still
      const double cost = least[i] + between(unit.at[open[i]], to, true, prices).total;
      if (cost < least[j]) least[j] = cost, before[j] = i;
    }
  }
  BestOfUnit best;
  std::size_t last = n;
  if (within(first, unit.end, unit.risk)) best.cost = between(first, unit.end, false, prices).total;
  for (std::size_t i = 0; i < n; ++i) {
    if (!within(unit.at[open[i]], unit.end, unit.risk)) continue;
    const double cost = least[i] + between(unit.at[open[i]], unit.end, false, prices).total;
    if (cost < best.cost) best.cost = cost, last = i;
  }
  for (; last != n; last = before[last]) best.chosen.push_back(open[last]);
  std::reverse(best.chosen.begin(), best.chosen.end());
  return best;
}

class VisitSearch {
 public:
  VisitSearch(std::span<const LifeAhead> units, std::span<const InspectionBounds> bounds,
              const InspectionPrices& prices, std::span<const double> candidates,
              const Monitor& monitor)
      : prices_(prices),
        visit_(prices.visit),
        count_(candidates.size()),
        progress_(monitor, "sets of visits") {
    prices_.visit = 0;
    for (std::size_t u = 0; u < units.size(); ++u) {
      UnitPlaces places;
      places.risk = bounds[u].risk;
      for (const double each : candidates)
        places.at.push_back(inspection_place(units[u], prices, each));
      places.end = inspection_place(units[u], prices, bounds[u].until);
      units_.push_back(std::move(places));
    }
  }

  std::vector<BestOfUnit> each(const std::vector<std::size_t>& visits,
                               const InspectionPrices& prices) const {
    std::vector<BestOfUnit> best(units_.size());
    tbb::parallel_for(std::size_t{0}, units_.size(),
                      [&](std::size_t u) { best[u] = best_of_unit(units_[u], visits, prices); });
    return best;
  }
  const InspectionPrices& own_prices() const { return prices_; }

  double total(const std::vector<std::size_t>& visits) const {
    progress_.advance(1);
    double sum = visit_ * static_cast<double>(visits.size());
    for (const BestOfUnit& best : each(visits, prices_)) sum += best.cost;
    return sum;
  }

  // Changes of one visit at a time until none saves anything.
  double descend(std::vector<std::size_t>& visits) const {
    double cost = total(visits);
    for (bool better = true; better;) {
      better = false;
      const auto attempt = [&](std::vector<std::size_t> changed) {
        std::sort(changed.begin(), changed.end());
        const double now = total(changed);
        // From no plan at all any step is one.
        if (!(now < cost - 1e-12 * std::abs(cost)) && !(std::isinf(cost) && now < cost)) return;
        cost = now;
        visits = std::move(changed);
        better = true;
      };
      for (std::size_t k = visits.size(); k-- > 0;) {
        if (k >= visits.size()) continue;
        std::vector<std::size_t> without = visits;
        without.erase(without.begin() + static_cast<std::ptrdiff_t>(k));
        attempt(without);
      }
      for (std::size_t k = 0; k < visits.size(); ++k) {
        const std::size_t low = k == 0 ? 0 : visits[k - 1] + 1;
        const std::size_t high = k + 1 < visits.size() ? visits[k + 1] : count_;
        for (std::size_t c = low; c < high; ++c) {
          if (c == visits[k]) continue;
          std::vector<std::size_t> moved = visits;
          moved[k] = c;
          attempt(std::move(moved));
        }
      }
      for (std::size_t c = 0; c < count_; ++c) {
        if (std::binary_search(visits.begin(), visits.end(), c)) continue;
        std::vector<std::size_t> more = visits;
        more.push_back(c);
        attempt(std::move(more));
      }
      // Two neighbours as one.
      for (std::size_t k = 0; k + 1 < visits.size(); ++k) {
        const std::size_t high = k + 2 < visits.size() ? visits[k + 2] : count_;
        for (std::size_t c = k == 0 ? 0 : visits[k - 1] + 1; c < high && k + 1 < visits.size();
             ++c) {
          std::vector<std::size_t> merged = visits;
          merged.erase(merged.begin() + static_cast<std::ptrdiff_t>(k));
          merged[k] = c;
          attempt(std::move(merged));
        }
      }
    }
    return cost;
  }

  std::size_t count() const { return count_; }

 private:
  InspectionPrices prices_;  // without visits
  double visit_ = 0;
  std::size_t count_ = 0;
  mutable wearwell::Progress progress_;
  std::vector<UnitPlaces> units_;
};

std::vector<std::size_t> all_of(std::size_t count) {
  std::vector<std::size_t> all(count);
  for (std::size_t i = 0; i < count; ++i) all[i] = i;
  return all;
}

// Sets of visits to start from: none, all, those of all units planned alone and of each of them, and
// every second, eighth, ... candidate.
std::vector<std::vector<std::size_t>> starts(const VisitSearch& search,
                                             const std::vector<BestOfUnit>& alone) {
  constexpr std::size_t most_units = 8, dense = 24;
  std::vector<std::vector<std::size_t>> sets = {{}};
  if (search.count() <= dense) sets.push_back(all_of(search.count()));
  std::vector<std::size_t> together;
  for (const BestOfUnit& each : alone) {
    together.insert(together.end(), each.chosen.begin(), each.chosen.end());
    if (alone.size() <= most_units) sets.push_back(each.chosen);
  }
  std::sort(together.begin(), together.end());
  together.erase(std::unique(together.begin(), together.end()), together.end());
  sets.push_back(together);
  for (std::size_t every = 2; every < search.count(); every *= 4) {
    sets.emplace_back();
    for (std::size_t i = every / 2; i < search.count(); i += every) sets.back().push_back(i);
  }
  return sets;
}

}  // namespace

JointVisits cheapest_visits(std::span<const LifeAhead> units,
                            std::span<const InspectionBounds> bounds,
                            const InspectionPrices& prices, std::span<const double> candidates,
                            const Monitor& monitor) {
  const VisitSearch search(units, bounds, prices, candidates, monitor);
  InspectionPrices shared = prices;
  shared.visit = prices.visit / static_cast<double>(units.size());
  const std::vector<BestOfUnit> alone = search.each(all_of(candidates.size()), shared);
  JointVisits joint;
  for (const BestOfUnit& each : alone) joint.least_possible += each.cost;
  std::vector<std::size_t> best;
  joint.total = out_of_reach;
  if (!std::isfinite(joint.least_possible)) return joint;
  for (std::vector<std::size_t> visits : starts(search, alone)) {
    const double cost = search.descend(visits);
    if (cost < joint.total) joint.total = cost, best = visits;
  }
  const std::vector<BestOfUnit> chosen = search.each(best, search.own_prices());
  for (const std::size_t each : best) joint.visits.push_back(candidates[each]);
  for (std::size_t u = 0; u < units.size(); ++u) {
    joint.of_unit.emplace_back();
    for (const std::size_t each : chosen[u].chosen)
      joint.of_unit.back().push_back(candidates[each]);
    joint.costs.push_back(
        cost_of(units[u], joint.of_unit.back(), bounds[u].until, search.own_prices()));
  }
  return joint;
}

std::vector<double> visit_candidates(std::span<const LifeAhead> units,
                                     std::span<const InspectionBounds> bounds,
                                     const InspectionPrices& prices, std::size_t most) {
  std::vector<double> times;
  double until = 0;
  for (std::size_t u = 0; u < units.size(); ++u) {
    const CheapestTimes alone = cheapest_inspections(units[u], bounds[u], prices);
    times.insert(times.end(), alone.plan.times.begin(), alone.plan.times.end());
    until = std::max(until, bounds[u].until);
    if (units[u].passed() > 0) times.push_back(0);
  }
  const Visits fewest = fewest_visits(units, bounds);
  times.insert(times.end(), fewest.visits.times.begin(), fewest.visits.times.end());
  const double step = bounds[0].step;
  const std::size_t even = step > 0 ? static_cast<std::size_t>(until / step) : most / 2;
  const std::size_t skip = std::max<std::size_t>(1, even / (most / 2));
  for (std::size_t i = skip; i <= even; i += skip)
    times.push_back(step > 0 ? step * static_cast<double>(i)
                             : until * static_cast<double>(i) / static_cast<double>(even + 1));
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::erase_if(times, [&](double x) { return x >= until; });
  if (times.size() <= most) return times;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(times[i * (times.size() - 1) / (most - 1)]);
  few.erase(std::unique(few.begin(), few.end()), few.end());
  return few;
}

}  // namespace wearwell::plan
