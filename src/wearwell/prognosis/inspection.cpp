#include "wearwell/prognosis/inspection.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "wearwell/base/stop_scope.h"
#include "wearwell/prognosis/least.h"

namespace wearwell::prognosis {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double as_good = 1.01;

// The sum of S(k interval) over k = 1, 2, ...; infinite if some never fail. In the tail, where S is
// small, it is the integral of S (Euler and Maclaurin).
double later_inspections(const WeightedLives& lives, double interval) {
  const auto points = lives.points();
  if (!std::isfinite(points.back())) return never;
  constexpr double small = 1e-4;
  constexpr int most = 100'000;
  double sum = 0, at = 0, left = 1;
  for (int k = 1; k <= most && left > small; ++k) {
    at = k * interval;
    left = 1 - lives.cdf(at);
    sum += left;
  }
  const double beyond = lives.mean_up_to(4 * points.back()) - lives.mean_up_to(at);
  return left > 0 ? sum + std::max(0.0, beyond / interval - left / 2) : sum;
}

using Inspected = std::function<InspectedLife(const WeightedLives&, double)>;

double rate_of(const PopulationLives& lives, const Inspected& inspected, double interval) {
  double sum = 0, mass = 0;
  for (std::size_t k = 0; k < lives.lives.size(); ++k) {
    const InspectedLife one = inspected(lives.lives[k], interval);
    sum += lives.weight[k] * one.cost / one.length;
    mass += lives.weight[k];
  }
  return sum / mass;
}

// From a hundredth of a life that most reach to one that few exceed.
std::vector<double> intervals_of(const PopulationLives& lives) {
  double low = never, high = 0;
  for (const WeightedLives& each : lives.lives) {
    low = std::min(low, each.quantile(0.05) / 100);
    const double most = each.quantile(0.95);
    high = std::max(high, std::isfinite(most) ? most : 10 * each.quantile(0.05));
  }
  if (!(low > 0) || !std::isfinite(low)) low = high / 5000;
  std::vector<double> intervals;
  constexpr int count = 240;
  for (int i = 0; i <= count; ++i)
    intervals.push_back(low * std::pow(high / low, static_cast<double>(i) / count));
  return intervals;
}

InspectionInterval cheapest(const PopulationLives& lives, const Inspected& inspected) {
  const std::vector<double> intervals = intervals_of(lives);
  const auto rate = [&](double interval) { return rate_of(lives, inspected, interval); };
  const Least least = least_of(rate, intervals);
  InspectionInterval best{least.at, least.value, least.at, least.at, 0, 0};
  for (const double each :
       intervals) {  // the rate is not smooth: the near-optimal set may be disconnected
    if (rate(each) > as_good * best.rate) continue;
    best.from = std::min(best.from, each);
    best.to = std::max(best.to, each);
  }
  double mass = 0;
  for (std::size_t k = 0; k < lives.lives.size(); ++k) {
    const InspectedLife one = inspected(lives.lives[k], best.interval);
    best.inspections += lives.weight[k] * one.inspections;
    best.failing += lives.weight[k] * one.failing;
    mass += lives.weight[k];
  }
  best.inspections /= mass;
  best.failing /= mass;
  return best;
}

}  // namespace

InspectedLife hidden_failure(const WeightedLives& lives, const Costs& costs, double hidden,
                             double interval) {
  check_stop();
  InspectedLife life;
  life.inspections = 1 + later_inspections(lives, interval);
  life.length = interval * life.inspections;
  const double mean = lives.mean_up_to(4 * lives.points().back());
  life.cost = costs.inspection * life.inspections + hidden * (life.length - mean) + costs.failure;
  life.failing = 1;
  return life;
}

InspectedLife perfect_inspection(const WeightedLives& lives, const Costs& costs, double interval) {
  check_stop();
  InspectedLife life;
  life.failing = lives.cdf(interval);
  life.inspections = later_inspections(lives, interval);
  const double failed_early = lives.mean_up_to(interval) - interval * (1 - life.failing);
  life.cost = costs.failure * life.failing + costs.replacement * (1 - life.failing) +
              costs.inspection * life.inspections;
  life.length = failed_early + interval * life.inspections;
  return life;
}

InspectionInterval cheapest_interval(const PopulationLives& lives, const Costs& costs) {
  InspectionInterval best = cheapest(lives, [&](const WeightedLives& each, double interval) {
    return perfect_inspection(each, costs, interval);
  });
  const double without = cost_rate(lives, costs, never);
  if (without <= best.rate) best = {never, without, best.from, never, 0, 1};
  return best;
}

InspectionInterval cheapest_hidden_interval(const PopulationLives& lives, const Costs& costs,
                                            double hidden) {
  return cheapest(lives, [&](const WeightedLives& each, double interval) {
    return hidden_failure(each, costs, hidden, interval);
  });
}

}  // namespace wearwell::prognosis
