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
  double at = 0;
  double until = 0;
  /// Left truncation: smaller values are not observable.
  double entry = -std::numeric_limits<double>::infinity();
  double trials = 0;  ///< of the binomial family
};

/// A log density or log probability with its derivatives by the slots.
struct ResponseTerm {
  double value = 0;
  double slope[most_response_parameters] = {};
};

/// For one observation, natural logarithm; -infinity if a slot is invalid or the observation is
/// outside the support. Accurate far in the tails. `slots` has those of the family.
ResponseTerm log_response(ResponseFamily family, const Response& response, const double* slots);
double log_response_value(ResponseFamily family, const Response& response, const double* slots);

/// log P(Y <= y) and log P(Y > y); for counts P(Y <= y) includes whole numbers up to y. NaN if a
/// slot is invalid.
double log_cdf(ResponseFamily family, double y, const double* slots, double trials = 0);
double log_survival(ResponseFamily family, double y, const double* slots, double trials = 0);

/// The y with P(Y <= y) = p, 0 < p < 1, for a family that is not a count.
double quantile(ResponseFamily family, double p, const double* slots);

/// The mean if it exists and has a formula; else the median.
double center(ResponseFamily family, const double* slots);

}  // namespace wearwell
