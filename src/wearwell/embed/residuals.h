#pragma once

#include <string>
#include <vector>

#include "wearwell/embed/run.h"

namespace wearwell::embed {

/// Quantile residuals of the observations (Dunn and Smyth 1996), in their order.
struct Residuals {
  /// Medians over draws of the posterior of the normal scores that the check `fit` tests: standard
  /// normal if the model is right. An observation that is known only to lie in an interval, as a
  /// run-out, has the score in the middle of the probability of that interval.
  std::vector<double> score;
  std::vector<int> censored;  ///< 1 of those
  std::string noun;           ///< what an observation is: "row"
};

/// Throws InputError for a study without a posterior or whose model has no scores.
Residuals residuals(const Run& run);

}  // namespace wearwell::embed
