#pragma once

#include <limits>

#include "wearwell/prob/family_form.h"

namespace wearwell {

/// The censoring of an observation.
enum class Censoring {
  none,
  right,     ///< right-censored (a run-out): larger than `at`
  left,      ///< smaller than `at`
  interval,  ///< more than `at`, up to `until`
};

/// One observation, in SI.
struct Response {
  Censoring seen = Censoring::none;
  double at =
      0;  ///< the value, or the bound that it lies above or below; of an interval the lower end
  double until = 0;  ///< of an interval the upper end
  /// It would not have been seen below that (left truncation).
  double entry = -std::numeric_limits<double>::infinity();
  double trials = 0;  ///< of the binomial family
};

/// A natural log density or log probability with its derivatives by the slots.
struct ResponseTerm {
  double value = 0;
  double slope[most_response_parameters] = {};
};

/// Log-likelihood of one observation: log density of an exact one, log probability of a censored one,
/// given that it lies above `entry` (Meeker and Escobar 1998, ch. 2). -infinity where the slots lie
/// outside their kind or the observation outside the support. It has all digits far in the tails.
/// `family_parameters` has the parameters of the family, SI, in their order.
ResponseTerm log_response(ResponseFamily family, const Response& response,
                          const double* family_parameters);
double log_response_value(ResponseFamily family, const Response& response,
                          const double* family_parameters);

/// log P(Y <= y) and log P(Y > y); for counts P(Y <= y) includes whole numbers up to y. NaN if a
/// slot is invalid.
double log_cdf(ResponseFamily family, double y, const double* family_parameters, double trials = 0);
double log_survival(ResponseFamily family, double y, const double* family_parameters,
                    double trials = 0);

/// The y with P(Y <= y) = p, 0 < p < 1, of a continuous family.
double quantile(ResponseFamily family, double p, const double* family_parameters);

/// The mean if it exists and has a formula; else the median.
double center(ResponseFamily family, const double* family_parameters);

}  // namespace wearwell
