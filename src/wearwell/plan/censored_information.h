#pragma once

#include <array>

#include "wearwell/math/hermite_table.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell::plan {

/// Fisher information of one observation, log life = location + scale * Z, that is censored at the
/// standardized log time zeta = (log time - location)/scale: expected products of the scores of
/// location and scale, times scale^2.
struct LocationScaleInformation {
  double location = 0, both = 0, scale = 0;
};

/// The information for any censoring time. It is the integral of (d log hazard / d parameter)^2
/// over the density up to zeta (Efron and Johnstone 1990), tabulated once by Gauss-Legendre
/// quadrature; algorithm AS 292 (Escobar and Meeker 1994) computes the same.
class CensoredInformation {
 public:
  explicit CensoredInformation(StandardDistribution distribution);
  /// Relative error below 1e-6; zero where less than 10^-18 fail.
  LocationScaleInformation operator()(double zeta) const;

 private:
  double lowest_, highest_;
  std::array<HermiteTable, 3> tables_;
  LocationScaleInformation complete_;
};

}  // namespace wearwell::plan
