#include "wearwell/prognosis/warranty.h"

#include <vector>

namespace wearwell::prognosis {

Warranty longest_warranty(const PopulationLives& lives, double share) {
  constexpr double unsure = 0.05;
  std::vector<double> length;
  for (const WeightedLives& each : lives.lives) length.push_back(each.quantile(share));
  // One population is known for sure.
  const double sure =
      length.size() > 1 ? WeightedLives(length, lives.weight).quantile(unsure) : length.front();
  return {share, lives.quantile(share), sure};
}

}  // namespace wearwell::prognosis
