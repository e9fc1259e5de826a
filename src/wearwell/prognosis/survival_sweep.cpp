#include "wearwell/prognosis/survival_sweep.h"

#include <algorithm>
#include <cmath>

namespace wearwell::prognosis {
namespace {

// Adds weight * cdf, the cdf as WeightedLives has it.
void add_failed(const WeightedLives& lives, double weight, std::span<const double> ascending,
                std::vector<double>& failed) {
  const auto life = lives.points(), share = lives.weights();
  std::size_t passed = 0;  // points at or before the place
  double before = 0;       // their weight, but for that of the last
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    const double x = ascending[i];
    for (; passed < life.size() && life[passed] <= x; ++passed)
      before += passed > 0 ? share[passed - 1] : 0;
    if (passed == 0) continue;
    const double last = share[passed - 1];
    if (passed == life.size() || std::isinf(life[passed])) {
      failed[i] += weight * (before + last);
      continue;
    }
    const double part = (x - life[passed - 1]) / (life[passed] - life[passed - 1]);
    double between = before + 0.5 * last + part * 0.5 * (last + share[passed]);
    if (life.front() == 0) between = std::max(share.front(), between);
    failed[i] += weight * between;
  }
}

}  // namespace

std::vector<double> survivals(const PopulationLives& lives, std::span<const double> ascending) {
  std::vector<double> all(ascending.size(), 0);
  double mass = 0;
  for (std::size_t k = 0; k < lives.lives.size(); ++k) {
    add_failed(lives.lives[k], lives.weight[k], ascending, all);
    mass += lives.weight[k];
  }
  for (double& each : all) each = 1 - each / mass;
  return all;
}

}  // namespace wearwell::prognosis
