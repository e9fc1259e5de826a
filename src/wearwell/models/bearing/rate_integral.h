#pragma once

#include <vector>

#include "wearwell/models/bearing/inspected.h"

namespace wearwell::bearing {

/// log of the likelihood of one bearing whose ln k is normal with mean `log_k`, and its
/// derivatives.
struct RateIntegral {
  double value = 0;
  double by_log_k = 0, by_sigma = 0, by_scatter = 0;
};

/// The logarithm of
///
///   int N(z; 0, 1) L(log_k + scatter z, sigma) dz.
///
/// If the integrand has a single peak, as nearly always, by the trapezoidal rule around its
/// maximum, which converges faster than any power of the step for analytic integrands; the sum over
/// every second node estimates its error. Otherwise (edges, plateaus, several maxima) by adaptive
/// Gauss-Kronrod panels. The choice, and the range, follow from bounds on the tails. At most some
/// thousand evaluations for any data. -infinity if the integrand is nowhere above exp(-1e9).
RateIntegral log_rate_integral(const Inspected& bearing, double log_k, double sigma,
                               double scatter);

/// A node of an even rule for that integral, which is the sum of exp(log_weight).
struct RateNode {
  double z, log_weight;
};

/// Nodes that together represent the distribution of the bearing's own rate, ln k = log_k + scatter
/// z: over the range where the integrand exceeds 1e-10 of its maximum, with distance `step` of its
/// width if it has a single peak, denser around each feature otherwise. `shift` of a step, 0 to 1,
/// moves them, so that the nodes of different points of a posterior do not coincide. Empty if the
/// integral is 0.
std::vector<RateNode> rate_nodes(const Inspected& bearing, double log_k, double sigma,
                                 double scatter, double step, double shift = 0);

}  // namespace wearwell::bearing
