#pragma once

#include <functional>
#include <vector>

namespace wearwell {

/// The normal score of an observation under given parameters: the z with Phi(z) = P(Y <= y). A
/// censored observation, such as a run-out, has both ends; -infinity or infinity for an open end.
struct NormalScore {
  double low = 0;
  double high = 0;

  bool exact() const { return low == high; }
};

/// The scores of all observations under parameters x, in order. Dependent observations, such as
/// those of one bearing, are scored conditionally on the previous ones: under the true model the
/// scores of exact observations are independent and standard normal (Rosenblatt 1952).
using Scores = std::function<std::vector<NormalScore>(const double* x)>;

/// The z with log Phi(z) = `log_cdf` and log Phi(-z) = `log_survival`: accurate in both tails.
double normal_score(double log_cdf, double log_survival);

/// Phi(z).
double normal_cdf(double z);

}  // namespace wearwell
