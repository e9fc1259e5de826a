#include "wearwell/prognosis/population_weights.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell::prognosis {
namespace {

// The smallest number of populations that must carry the weight given the readings of all units;
// half of the initial number if that is smaller.
constexpr double least_effective = 50;

// Normalizes the weights; returns their effective sample size.
double normalized(const std::vector<double>& log_weight, std::vector<double>& weight) {
  const double top = *std::max_element(log_weight.begin(), log_weight.end());
  weight.clear();
  double sum = 0, square = 0;
  for (const double each : log_weight) sum += weight.emplace_back(std::exp(each - top));
  for (double& each : weight) {
    each /= sum;
    square += each * each;
  }
  return 1 / square;
}

}  // namespace

PopulationWeights weights_given(std::span<const double> prior,
                                std::span<const double> log_likelihood) {
  PopulationWeights given;
  std::vector<double> log_weight;
  for (const double each : prior) log_weight.push_back(std::log(each));
  const double before = normalized(log_weight, given.weight);
  given.effective = before;
  bool shown = false;
  for (std::size_t k = 0; k < prior.size(); ++k) {
    log_weight[k] += log_likelihood[k];
    shown |= log_likelihood[k] != 0;
  }
  if (!shown) return given;
  const bool possible = std::any_of(log_weight.begin(), log_weight.end(),
                                    [](double each) { return each > -infinity; });
  given.effective = possible ? normalized(log_weight, given.weight) : 0;
  given.resolved = given.effective >= std::min(least_effective, 0.5 * before);
  return given;
}

}  // namespace wearwell::prognosis
