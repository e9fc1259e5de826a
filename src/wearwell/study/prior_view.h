#pragma once

#include <string>
#include <vector>

#include "wearwell/study/plots.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// The prior of one parameter, in its unit: its quantiles, and its density between those of 0.5 and 99.5 %.
/// An improper prior has neither.
struct PriorPicture {
  std::string name, meaning, unit;
  bool proper = true;
  double q05 = 0, q50 = 0, q95 = 0;
  bool log = false;  ///< then `curve` is the density of ln x, for a logarithmic axis
  Curve curve = {};
};

/// What a study says before any data: its priors, and the quantities that they imply (the prior predictive).
struct PriorView {
  std::vector<PriorPicture> priors;  ///< of the parameters, without the effects of single units
  /// From `prior_draws` draws of the priors. Empty with an `obstacle`.
  std::vector<QuantitySummary> quantities;
  std::string obstacle;  ///< why there are no quantities, as a sentence
};
inline constexpr int prior_draws = 1000;
PriorPicture prior_picture(const Parameter& parameter, const std::string& meaning);
PriorView prior_view(const PosteriorStudy& study);

}  // namespace wearwell
