#pragma once

#include <vector>

#include "wearwell/models/bearing/inspected.h"

namespace wearwell::bearing {

/// log of the likelihood of one bearing whose ln k is normal about `log_k`, and its derivatives.
struct RateIntegral {
  double value = 0;
  double by_log_k = 0, by_sigma = 0, by_scatter = 0;
};

/// The logarithm of
///
///   int N(z; 0, 1) L(log_k + scatter z, sigma) dz.
///
/// Where the integrand is one bell, as nearly always, by the trapezoidal rule about its top, which
/// converges faster than any power of the step for bells that are analytic; every second node alone
/// tells how well. Else (edges, plateaus, several tops) by adaptive Gauss-Kronrod panels. Which of
/// them, and where to stop, follows from bounds on what lies farther out. At most some thousand
/// evaluations, whatever the data. -infinity where the integrand is nowhere above exp(-1e9).
RateIntegral log_rate_integral(const Inspected& bearing, double log_k, double sigma,
                               double scatter);

/// A node of an even rule for that integral, which is the sum of exp(log_weight).
struct RateNode {
  double z, log_weight;
};

/// Nodes that together are the law of the bearing's own rate, ln k = log_k + scatter z: over all of the
/// integrand that is more than 1e-10 of its top, `step` of its width apart where it is one bell, close
/// about each of its features where it is not. `shift` of a step, 0 to 1, moves them: the nodes of many
/// points of a posterior shall not stand in the same places. None where the integral is 0.
std::vector<RateNode> rate_nodes(const Inspected& bearing, double log_k, double sigma,
                                 double scatter, double step, double shift = 0);

}  // namespace wearwell::bearing
