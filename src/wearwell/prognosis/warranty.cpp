#include "wearwell/prognosis/warranty.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wearwell::prognosis {
namespace {

constexpr double unsure = 0.05;

// Of the quantile `unsure` of points of these weights, relative: half the way between the quantiles one
// standard deviation of the share below it to either side.
std::optional<double> sampling_error(const WeightedLives& points) {
  double squares = 0;
  for (const double each : points.weights()) squares += each * each;
  const double off = std::sqrt(unsure * (1 - unsure) * squares);
  const double low = points.quantile(std::max(0.0, unsure - off)),
               high = points.quantile(std::min(1.0, unsure + off)), at = points.quantile(unsure);
  if (!std::isfinite(high) || !(at > 0)) return {};
  return 0.5 * (high - low) / at;
}

}  // namespace

Warranty longest_warranty(const PopulationLives& lives, double share) {
  std::vector<double> length;
  for (const WeightedLives& each : lives.lives) length.push_back(each.quantile(share));
  Warranty warranty{share, lives.quantile(share), length.front()};
  if (length.size() == 1) return warranty;  // one population is known for sure
  const WeightedLives points(length, lives.weight);
  warranty.sure = points.quantile(unsure);
  warranty.populations = length.size();
  warranty.error = sampling_error(points);
  return warranty;
}

Warranty longest_warranty(const KnownLives& lives, double share) {
  const auto fitted = lives.b_life ? lives.b_life(share, 1 - unsure) : std::nullopt;
  if (!fitted) return longest_warranty(lives.fresh, share);
  return {share, fitted->predictive, fitted->bound, 0, fitted->numerical_error};
}

}  // namespace wearwell::prognosis
