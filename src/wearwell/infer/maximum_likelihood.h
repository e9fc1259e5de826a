#pragma once

#include <Eigen/Dense>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/infer/density_profile.h"

namespace wearwell {

/// The scale on which an estimate of a parameter is taken as normal: the logarithm of a positive
/// parameter, the logit log(p/(1 - p)) of a share, or the parameter itself.
enum class NormalScale { logarithm, natural, logit };

double to_normal_scale(NormalScale scale, double x);
double from_normal_scale(NormalScale scale, double z);

/// An estimate on the scale of its normal approximation, with bounds there.
struct ClassicalBounds {
  double estimate = 0;
  double error = 0;  ///< standard error by the delta method
  double lower = 0, upper = 0;
  ProfileInterval likelihood_ratio;
};

/// The maximum of a likelihood, without priors, and confidence bounds of functions of its
/// parameters.
class MaximumLikelihood {
 public:
  /// Searches from `starts`, natural parameters inside their support. `widths` > 0 are about their
  /// uncertainty. Among several maxima the highest with positive definite curvature counts.
  MaximumLikelihood(std::shared_ptr<const LogDensity> likelihood, std::vector<NormalScale> scales,
                    const std::vector<Eigen::VectorXd>& starts, const Eigen::VectorXd& widths);

  /// Whether there is a maximum; without one only `rising` has a meaning.
  bool found() const { return found_; }
  /// The parameter that the search moved farthest, in its width.
  Eigen::Index rising() const { return rising_; }
  /// Where the highest search ended, natural; a share that goes to 0 or 1 is near it.
  const Eigen::VectorXd& highest() const { return highest_; }
  /// Whether a search ended higher without a maximum there: a likelihood with a threshold has no
  /// bound as the threshold approaches the first life.
  bool higher_elsewhere() const { return higher_elsewhere_; }
  const Eigen::VectorXd& position() const { return position_; }  ///< natural
  double log_likelihood() const { return maximum_.value; }
  /// Of the parameters on their scales: the inverse of the observed Fisher information.
  const Eigen::MatrixXd& covariance() const { return covariance_; }

  /// Bounds that a parameter, on its scale, exceeds with probability (1 + level)/2 and (1 - level)/2.
  /// The normal ones are estimate -+ z error (Wald); the likelihood-ratio ones are those of the
  /// profile (infer/profile.h).
  ClassicalBounds of_parameter(Eigen::Index i, double level) const;

  /// A function of natural parameters on the scale of its normal approximation. Called by one thread.
  using Quantity = std::function<double(const double* x)>;
  /// Continuous, positive where the quantity exceeds `value` and negative where it is less. The
  /// difference of both serves, but a quantile is compared much faster by its distribution function.
  using Comparison = std::function<double(const double* x, double value)>;
  ClassicalBounds of(const Quantity& quantity, const Comparison& above, double level) const;

 private:
  class OnScale;
  class WithQuantity;
  Eigen::VectorXd gradient(const Quantity& at_scale) const;

  std::shared_ptr<const OnScale> density_;
  ProfiledMaximum maximum_;  // on the scales
  Eigen::VectorXd position_, highest_;
  Eigen::MatrixXd covariance_;
  bool found_ = false, higher_elsewhere_ = false;
  Eigen::Index rising_ = 0;
};

}  // namespace wearwell
