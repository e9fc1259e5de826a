#include "wearwell/plan/censored_information.h"

#include <cmath>

#include "wearwell/math/quadrature.h"

namespace wearwell::plan {
namespace {

// Derivatives by zeta of the three integrals: k^2, k (1 + z k), (1 + z k)^2 times the density, with
// k the slope of the log hazard.
std::array<double, 3> information_density(StandardDistribution distribution, double z) {
  const ValueAndSlope density = log_density_and_slope(distribution, z);
  const double k = density.slope - log_survival_and_slope(distribution, z).slope;
  const double f = std::exp(density.value), by_scale = 1 + z * k;
  return {k * k * f, k * by_scale * f, by_scale * by_scale * f};
}

// Beyond them the density is below 10^-18 and adds nothing.
double information_reach(StandardDistribution distribution) {
  return distribution == StandardDistribution::normal ? 9 : 42;
}

}  // namespace

CensoredInformation::CensoredInformation(StandardDistribution distribution)
    : lowest_(-information_reach(distribution)),
      highest_(distribution == StandardDistribution::smallest_extreme_value
                   ? 5
                   : information_reach(distribution)) {
  constexpr double points_per_unit = 32;
  const GaussLegendre rule = gauss_legendre(8);
  for (std::size_t i = 0; i < 3; ++i) {
    double from = lowest_, sum = 0;
    tables_[i] =
        HermiteTable(lowest_, highest_ + 2 / points_per_unit, points_per_unit, [&](double to) {
          const double half = 0.5 * (to - from), middle = 0.5 * (to + from);
          for (std::size_t j = 0; j < rule.node.size(); ++j)
            sum += half * rule.weight[j] *
                   information_density(distribution, middle + half * rule.node[j])[i];
          from = to;
          return HermiteTable::Point{sum, information_density(distribution, to)[i]};
        });
  }
  complete_ = {tables_[0](highest_).value, tables_[1](highest_).value, tables_[2](highest_).value};
}

LocationScaleInformation CensoredInformation::operator()(double zeta) const {
  if (zeta <= lowest_) return {};
  if (zeta >= highest_) return complete_;
  return {tables_[0](zeta).value, tables_[1](zeta).value, tables_[2](zeta).value};
}

}  // namespace wearwell::plan
