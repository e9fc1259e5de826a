#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/fit.h"

namespace wearwell {

/// Where a parameter's mode lies on its support.
enum class Place { inside, lower_bound, upper_bound };

/// Where prior times likelihood is highest as a density of the parameters in their own units,
/// without the Jacobian of any transform: with flat or uniform priors the maximum likelihood
/// estimate (within the bounds).
struct NaturalMode {
  std::string problem;      ///< why there is no mode; empty when there is one, else nothing below
                            ///< means anything
  bool fell_short = false;  ///< the problem is the search's, not the posterior's
  double above_draws =
      0;  ///< log density of the highest point found over that of the draws it began from
  Eigen::VectorXd position;   ///< natural, SI; on the bound where a bound holds it
  std::vector<Place> place;   ///< one a parameter
  double log_likelihood = 0;  ///< natural logarithm, data in SI
  double log_posterior = 0;   ///< log prior + log likelihood, parameters and data in SI
  /// From the curvature there: standard errors of parameters that no bound holds, nor two bounds
  /// closer than the data can tell; the held ones are taken for known: NaN for those.
  Eigen::VectorXd standard_error;
  bool maximum = false;  ///< every prior is flat or uniform: the likelihood is highest here as well
  int starts = 0;        ///< searches
  int reached = 0;       ///< of them ended here
};

/// Searches from the start values and from draws spread over the posterior, the highest among them,
/// by Newton's method within the bounds (projected, with the curvature made positive: Bertsekas
/// 1982).
NaturalMode constrained_mode(const Posterior& posterior, const Fit& fit);

}  // namespace wearwell
