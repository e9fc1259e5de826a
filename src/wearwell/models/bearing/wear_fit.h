#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/observation.h"
#include "wearwell/models/bearing/depth_function.h"

namespace wearwell::bearing {

/// Inspections of bearings, one entry each.
struct Inspections {
  std::vector<Duty> duty;            ///< until the inspection
  std::vector<double> depth;         ///< measured, m
  std::vector<std::size_t> bearing;  ///< index of the inspected bearing, from 0
};

/// The unknowns. Parameters in order: k [m^3/(N m)], sigma [m] unless the depth error is known,
/// k_scatter if the bearings vary.
struct WearModel {
  ObservationFamily family = ObservationFamily::normal;
  std::optional<double> depth_error;  ///< known standard deviation of a measured depth, m
  bool has_scatter = false;

  int dimension() const { return 1 + !depth_error + has_scatter; }
  double sigma(const double* x) const { return depth_error ? *depth_error : x[1]; }
  /// Standard deviation of ln k between bearings; 0 if they do not vary.
  double scatter(const double* x) const { return has_scatter ? x[dimension() - 1] : 0; }
};

/// The likelihood of the first `count` inspections. Depths follow the inverse geometry, d = r
/// delta(p_a k n), and are measured with standard deviation sigma.
///
/// Bearing b has k_b = k exp(k_scatter z_b), z_b ~ N(0, 1). The z_b are integrated out here, one
/// bearing at a time,
///
///   L_b = int N(z; 0, 1) prod_i p(d_i | k exp(k_scatter z), sigma) dz,
///
/// instead of being sampled: each is an integral over one variable, so the posterior keeps at most
/// three parameters for any number of bearings. Quadrature then reaches it (exact posterior,
/// evidence, the agreement check), NUTS meets no funnel, and the number of bearings is not limited.
/// The k of each single bearing is not part of the posterior.
///
/// `rate_integral.h` has the rule: bounded effort for any data, within 1e-6 of brute force, also
/// for inspections that contradict each other by any amount (tests).
///
/// A k that wears a bearing beyond its geometry is outside the support.
std::shared_ptr<const LogDensity> wear_likelihood(const WearModel& model,
                                                  const Inspections& inspections,
                                                  std::size_t count);

/// Start values of searches.
struct WearGuess {
  double k;        ///< all wear numbers over all loadings
  double sigma;    ///< root mean square residual of the depths at k
  double scatter;  ///< standard deviation of ln k between single inspections
};

/// Throws InputError if no depth is positive.
WearGuess guess(const Inspections& inspections);

}  // namespace wearwell::bearing
