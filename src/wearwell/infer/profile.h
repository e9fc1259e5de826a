#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/infer/constrained_mode.h"

namespace wearwell {

/// One end of a profile-likelihood interval; NaN where there is none, and `open` says why.
struct ProfileEnd {
  double value = 0;
  std::string open;
};

/// All values of a number that the likelihood allows: 2 (its maximum less its maximum under that
/// value) is at most chi-square's quantile with one degree of freedom (Venzon and Moolgavkar 1988).
/// Unlike a standard error it does not change with the way in which a parameter is written, and it
/// need not be symmetric.
struct ProfileInterval {
  ProfileEnd lower, upper;
};

/// A number that follows from the parameters, and fixes one of them when the others are known.
struct ProfiledQuantity {
  Eigen::Index parameter = 0;                    ///< the one that it fixes
  std::function<double(const double* x)> value;  ///< of natural parameters
  /// What that parameter must be for `value`, given the others in x; NaN where nothing does.
  std::function<double(const double* x, double value)> solve;
};

/// The intervals of all parameters, natural and in SI. `mode` is one (no problem); meant for flat
/// and uniform priors (mode.maximum), whose bounds close no interval: an end that is not reached
/// before the bound is open.
std::vector<ProfileInterval> profile_intervals(const Posterior& posterior, const Fit& fit,
                                               const NaturalMode& mode, double level);

/// The interval of one quantity.
ProfileInterval profile_interval(const Posterior& posterior, const Fit& fit,
                                 const NaturalMode& mode, const ProfiledQuantity& quantity,
                                 double level);

}  // namespace wearwell
