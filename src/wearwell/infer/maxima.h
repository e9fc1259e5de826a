#pragma once

#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/mode.h"

namespace wearwell {

/// A local maximum of a posterior on its real line.
struct LocalMaximum {
  Mode mode;
  double share = 1;  ///< share of the posterior's mass; at first by Laplace's approximation
  int reached = 0;   ///< number of searches that ended there
};

/// The local maxima of non-negligible mass found from many starts; the first is the center of all
/// later computations. Empty without a search.
struct Maxima {
  std::vector<LocalMaximum> found;
  int starts = 0;   ///< starts of searches, including the first
  double left = 0;  ///< expected number of undiscovered maxima of non-negligible mass

  bool several() const { return found.size() > 1; }
};

/// Searches for local maxima other than `known`, the maximum found from the start values, if any.
/// Quasi-random points (an additive recurrence) cover the prior's mass (for an improper prior: the
/// surroundings of the start value), the surroundings of the start values, and those of `known`.
/// Searches start from points that are higher than all of their neighbours (Torn and Viitanen 1994,
/// J. Global Optimization 5, 267-276), and from as many unselected points of the prior, until the
/// expected number of undiscovered maxima, w (w + 1)/(n - w - 2) after n searches that found w
/// (Boender and Rinnooy Kan 1987, Math. Programming 37, 59-80), is below a half and every point
/// within reach of the highest density was followed. Expensive likelihoods, judged by the number of
/// observations and `LogDensity::is_slow` and not by time, use fewer points, so the result is the
/// same on any machine. `known` stays the first unless another has more than e times its mass.
Maxima find_maxima(const Posterior& posterior, const Mode& known);

/// A sentence for the check of the computation, with the parameters in their units: "12 starts found one maximum"; "24 starts:
/// 2 maxima, at th = 2.01 (88 %) and th = -2.00 (12 %)".
std::string description(const Posterior& posterior, const Maxima& maxima);

}  // namespace wearwell
