#include "wearwell/models/fatigue/scatter_range.h"

#include <cmath>
#include <vector>

#include "wearwell/math/quantile.h"

namespace wearwell::fatigue {

ScatterRange scatter_range(const SnLaw& law, const WeightedDraws& draws) {
  const double width = quantile(law.standard(), 0.9) - quantile(law.standard(), 0.1);
  const auto k = [&](const double* x) { return law.curve == SnCurve::knee ? x[0] : -1 / x[1]; };
  std::vector<WeightedValue> life, stress, slope;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const double *x = draws.values.row(i).data(), weight = draws.weights[i];
    life.push_back({width * x[law.sigma_index()], weight});
    stress.push_back({life.back().value / k(x), weight});
    slope.push_back({k(x), weight});
  }
  const auto of = [](std::vector<WeightedValue>& all, double p) {
    return std::pow(10, weighted_quantile(all, p));
  };
  return {of(life, 0.05),
          of(life, 0.5),
          of(life, 0.95),
          of(stress, 0.05),
          of(stress, 0.5),
          of(stress, 0.95),
          weighted_quantile(slope, 0.05),
          weighted_quantile(slope, 0.5),
          weighted_quantile(slope, 0.95)};
}

}  // namespace wearwell::fatigue
