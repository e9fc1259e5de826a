#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/infer/constrained_mode.h"

namespace wearwell {

/// One end of a profile-likelihood interval; NaN for an open end, with the reason in `open`.
struct ProfileEnd {
  double value = 0;
  std::string open;
};

/// A profile-likelihood interval: all values with a deviance of at most the chi-square quantile
/// with one degree of freedom (Venzon and Moolgavkar 1988). Unlike a standard error it does not
/// depend on the parametrization, and it can be asymmetric.
struct ProfileInterval {
  ProfileEnd lower, upper;
};

/// A function of the parameters that determines one of them given the others.
struct ProfiledQuantity {
  Eigen::Index parameter = 0;                    ///< the one that it fixes
  std::function<double(const double* x)> value;  ///< of natural parameters
  /// The value of that parameter for `value`, given the others in x; NaN if there is none.
  std::function<double(const double* x, double value)> solve;
};

/// The intervals of all parameters, natural and in SI. `mode` must have no problem. Intended for
/// flat and uniform priors (mode.maximum); their bounds do not close an interval: an end that is
/// not reached before the bound is open.
std::vector<ProfileInterval> profile_intervals(const Posterior& posterior, const Fit& fit,
                                               const NaturalMode& mode, double level);

/// The interval of one quantity.
ProfileInterval profile_interval(const Posterior& posterior, const Fit& fit,
                                 const NaturalMode& mode, const ProfiledQuantity& quantity,
                                 double level);

}  // namespace wearwell
