#include "wearwell/prognosis/failure_totals.h"

#include <array>

#include "wearwell/predict/count_quantile.h"
#include "wearwell/prognosis/fleet_risk.h"

namespace wearwell::prognosis {
namespace {

// Up to so many units the distribution of the number of failures is summed exactly.
constexpr std::size_t most_convolved = 400;

}  // namespace

FailureTotals::FailureTotals(std::size_t horizons, std::size_t populations)
    : mean_(horizons, std::vector<double>(populations, 0)), variance_(mean_), kept_(horizons) {}

void FailureTotals::add(const std::vector<std::vector<double>>& failing, double units) {
  for (std::size_t h = 0; h < mean_.size(); ++h) {
    for (std::size_t k = 0; k < mean_[h].size(); ++k) {
      const double p = failing[h][k];
      mean_[h][k] += units * p;
      variance_[h][k] += units * p * (1 - p);
    }
  }
}

void FailureTotals::keep(const std::vector<std::vector<double>>& failing) {
  if (!few_ || kept_.empty()) return;
  few_ = kept_.front().size() < most_convolved;
  for (std::size_t h = 0; h < kept_.size(); ++h) {
    if (few_) {
      kept_[h].push_back(failing[h]);
    } else {
      kept_[h] = {};
    }
  }
}

FleetFailures FailureTotals::failures(std::size_t h, std::span<const double> weight) const {
  FleetFailures found;
  for (std::size_t k = 0; k < weight.size(); ++k) found.expected += weight[k] * mean_[h][k];
  if (few_) {
    std::vector<std::vector<double>> by_population(weight.size());
    for (const std::vector<double>& unit : kept_[h])
      for (std::size_t k = 0; k < weight.size(); ++k) by_population[k].push_back(unit[k]);
    const Count count = how_many(by_population, weight);
    found.low = static_cast<double>(enough_for(count, 0.05));
    found.high = static_cast<double>(enough_for(count, 0.95));
    return found;
  }
  std::vector<CountAtPoint> points;
  for (std::size_t k = 0; k < weight.size(); ++k)
    points.push_back({mean_[h][k], variance_[h][k], weight[k]});
  constexpr std::array<double, 2> ends = {0.05, 0.95};
  const std::vector<double> bounds = count_quantiles(points, ends);
  found.low = bounds[0];
  found.high = bounds[1];
  return found;
}

}  // namespace wearwell::prognosis
