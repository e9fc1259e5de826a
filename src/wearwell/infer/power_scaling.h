#pragma once

#include <span>

/// The sensitivity of a posterior to weakening or strengthening its prior or likelihood, after
/// Kallioinen, Paananen, Bürkner, Vehtari (2024), "Detecting and diagnosing prior and likelihood
/// sensitivity with power-scaling", Statistics and Computing 34, 57. No refit is needed: the draws
/// are weighted by p(theta)^(alpha - 1) or p(y | theta)^(alpha - 1).
///
/// Conventions of the R package priorsense, with two simplifications: the gradient divides each
/// distance by its own |log2(alpha)|, and the importance weights are not Pareto-smoothed (at these
/// alphas they vary by some per cent).
namespace wearwell {

/// Sensitivities at or above this are relevant.
inline constexpr double power_scaling_threshold = 0.05;

/// Sensitivities of one quantity: the change of its distribution per doubling of the component's
/// weight; dimensionless, 0 for no influence.
struct PowerScaling {
  double prior;
  double likelihood;
};

enum class PowerScalingVerdict {
  none,                             ///< the prior does not matter
  strong_prior_or_weak_likelihood,  ///< only the prior matters
  prior_data_conflict,              ///< both matter and contradict each other
  unknown                           ///< a sensitivity is NaN
};

/// `draws` of one quantity and, for the same draws, the log prior and the log likelihood of all
/// data, each up to a constant. The log prior is that of the parameters as the user states it:
/// without the Jacobian of a transform to the real line. `weights`: those of the draws, not
/// negative; empty for equal ones. Draws and weights of all chains together, in any order.
///
/// NaN if anything is not finite, no weight is positive, or all draws are equal. Throws
/// std::invalid_argument for different lengths.
PowerScaling power_scaling(std::span<const double> draws, std::span<const double> log_prior,
                           std::span<const double> log_likelihood,
                           std::span<const double> weights = {});

/// One of the two: the mean of distance/|log2(alpha)| over alpha = 0.99 and 1.01.
double power_scaling_sensitivity(std::span<const double> draws,
                                 std::span<const double> log_component,
                                 std::span<const double> weights = {});

PowerScalingVerdict verdict(const PowerScaling& sensitivity);

/// The cumulative Jensen-Shannon distance of two sets of weights p and q of the same draws, given
/// in ascending order; 0 to 1, invariant under shift, scale and sign of the draws. With P and Q the
/// weighted empirical distribution functions and M = (P + Q)/2 its square is
///   integral of P log2(P/M) + Q log2(Q/M) dx / integral of P + Q dx
/// between the smallest and the largest draw, or the same of -x, if larger (Nguyen and Vreeken
/// 2015). Weights are not negative; their sums are positive and need not be 1.
double cumulative_jensen_shannon(std::span<const double> sorted, std::span<const double> p,
                                 std::span<const double> q);

}  // namespace wearwell
