#include "wearwell/prognosis/fleet_risk.h"

#include <algorithm>
#include <cmath>

#include "wearwell/base/stop_scope.h"

namespace wearwell::prognosis {

Count how_many(std::span<const double> probability) {
  Count count = {1};
  count.reserve(probability.size() + 1);
  for (const double p : probability) {
    check_stop();
    count.push_back(0);
    for (std::size_t k = count.size() - 1; k > 0; --k)
      count[k] = count[k] * (1 - p) + count[k - 1] * p;
    count[0] *= 1 - p;
  }
  return count;
}

Count how_many(std::span<const std::vector<double>> probability, std::span<const double> weight) {
  double mass = 0;
  for (const double each : weight) mass += each;
  Count mixed;
  for (std::size_t k = 0; k < probability.size(); ++k) {
    if (weight[k] <= 0) continue;
    const Count one = how_many(probability[k]);
    mixed.resize(std::max(mixed.size(), one.size()), 0);
    for (std::size_t i = 0; i < one.size(); ++i) mixed[i] += weight[k] / mass * one[i];
  }
  return mixed;
}

double mean(const Count& count) {
  double sum = 0;
  for (std::size_t i = 0; i < count.size(); ++i) sum += static_cast<double>(i) * count[i];
  return sum;
}

double sd(const Count& count) {
  const double center = mean(count);
  double sum = 0;
  for (std::size_t i = 0; i < count.size(); ++i)
    sum += (static_cast<double>(i) - center) * (static_cast<double>(i) - center) * count[i];
  return std::sqrt(sum);
}

std::size_t enough_for(const Count& count, double level) {
  double sum = 0;
  for (std::size_t i = 0; i < count.size(); ++i)
    if ((sum += count[i]) >= level * (1 - 1e-12)) return i;
  return count.empty() ? 0 : count.size() - 1;
}

}  // namespace wearwell::prognosis
