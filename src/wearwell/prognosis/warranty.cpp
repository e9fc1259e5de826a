#include "wearwell/prognosis/warranty.h"

#include <vector>

namespace wearwell::prognosis {

Warranty longest_warranty(const PopulationLives& lives, double share) {
  constexpr double unsure = 0.05;
  std::vector<double> life, weight, length;
  for (std::size_t k = 0; k < lives.lives.size(); ++k) {
    const WeightedLives& each = lives.lives[k];
    life.insert(life.end(), each.points().begin(), each.points().end());
    for (const double of_point : each.weights()) weight.push_back(lives.weight[k] * of_point);
    length.push_back(each.quantile(share));
  }
  // One population is known for sure.
  const double sure =
      length.size() > 1 ? WeightedLives(length, lives.weight).quantile(unsure) : length.front();
  return {share, WeightedLives(life, weight).quantile(share), sure};
}

}  // namespace wearwell::prognosis
