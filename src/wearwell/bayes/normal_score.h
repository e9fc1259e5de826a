#pragma once

#include <functional>
#include <vector>

namespace wearwell {

/// Where an observation lies in the law that parameters give it, on the scale of the standard
/// normal law: the z with Phi(z) = P(it or less). Of an observation that is known only to lie
/// between two values, a run-out for example, both ends; -infinity and infinity where there is none.
struct NormalScore {
  double low = 0;
  double high = 0;

  bool exact() const { return low == high; }
};

/// The scores of all observations under parameters x, in order. Where observations depend on each
/// other, as those of one bearing do, each is scored in the light of those before it: under the law
/// and the true parameters scores of exact observations are independent and standard normal
/// (Rosenblatt 1952).
using Scores = std::function<std::vector<NormalScore>(const double* x)>;

/// The z with log Phi(z) = `log_cdf` and log Phi(-z) = `log_survival`: no digit is lost in either
/// tail.
double normal_score(double log_cdf, double log_survival);

/// Phi(z).
double normal_cdf(double z);

}  // namespace wearwell
