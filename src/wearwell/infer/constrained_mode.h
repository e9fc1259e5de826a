#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/fit.h"

namespace wearwell {

/// The position of a parameter's mode on its support.
enum class Place { inside, lower_bound, upper_bound };

/// The MAP estimate on the constrained scale: the maximum of prior times likelihood in natural
/// units, without the Jacobian of a transform. With flat or uniform priors it is the maximum
/// likelihood estimate (within the bounds).
struct NaturalMode {
  std::string problem;      ///< why there is no mode; empty if there is one, else nothing below
                            ///< means anything
  bool fell_short = false;  ///< the search failed; the posterior may have a mode
  double above_draws =
      0;  ///< log density of the highest point minus that of the highest starting draw
  Eigen::VectorXd position;   ///< natural, SI; may be at a bound
  std::vector<Place> place;   ///< one per parameter
  double log_likelihood = 0;  ///< natural logarithm, data in SI
  double log_posterior = 0;   ///< log prior + log likelihood, parameters and data in SI
  /// Standard errors from the curvature. NaN for parameters at a bound, or between bounds closer
  /// than the data resolve; these are treated as known.
  Eigen::VectorXd standard_error;
  bool maximum = false;  ///< every prior is flat or uniform, so this is also the maximum of the
                         ///< likelihood
  int starts = 0;        ///< searches
  int reached = 0;       ///< searches that ended here
};

/// Searches from the start values and from draws over the posterior, including the highest, by
/// projected Newton's method within the bounds (with curvature made positive definite: Bertsekas
/// 1982).
NaturalMode constrained_mode(const Posterior& posterior, const Fit& fit);

}  // namespace wearwell
