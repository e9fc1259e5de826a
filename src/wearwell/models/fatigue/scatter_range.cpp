#include "wearwell/models/fatigue/scatter_range.h"

#include <cmath>

namespace wearwell::fatigue {

ScatterRange scatter_range(const SnLaw& law, const WeightedDraws& draws) {
  const double width = quantile(law.standard(), 0.9) - quantile(law.standard(), 0.1);
  const auto k = [&](const double* x) { return law.curve == SnCurve::knee ? x[0] : -1 / x[1]; };
  const QuantityDistribution life(draws,
                                  [&](const double* x) { return width * x[law.sigma_index()]; });
  const QuantityDistribution stress(
      draws, [&](const double* x) { return width * x[law.sigma_index()] / k(x); });
  const QuantityDistribution slope(draws, k);
  const auto range = [](const QuantityDistribution& of, double p) {
    return std::pow(10, of.quantile(p));
  };
  return {range(life, 0.05),    range(life, 0.5),    range(life, 0.95),
          range(stress, 0.05),  range(stress, 0.5),  range(stress, 0.95),
          slope.quantile(0.05), slope.quantile(0.5), slope.quantile(0.95)};
}

}  // namespace wearwell::fatigue
