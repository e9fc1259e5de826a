#pragma once

#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/mode.h"

namespace wearwell {

/// A local maximum of a posterior on its real line.
struct LocalMaximum {
  Mode mode;
  double share =
      1;  ///< of the posterior's mass that lies about it: first by Laplace's approximation
  int reached = 0;  ///< so many searches ended there
};

/// The local maxima of non-negligible mass that a search from many starts found; the first is the one about which everything
/// is laid. Empty where no search was made.
struct Maxima {
  std::vector<LocalMaximum> found;
  int starts = 0;  ///< from which searches went uphill, the first one included
  double left =
      0;  ///< how many more maxima of non-negligible mass are to be expected, which no search has found

  bool several() const { return found.size() > 1; }
};

/// Searches for further local maxima than `known`, the one that the search from the start values found, if it found one. Quasi-random points
/// (an additive recurrence) fill the prior's mass (a parameter whose prior is improper: the surroundings of its start value),
/// the surroundings of the start values, and those of `known`. Uphill go the searches from points that are higher than
/// all of their neighbours (Torn and Viitanen 1994, J. Global Optimization 5, 267-276), and as many from points of the prior
/// as they lie, until the expected number of maxima not yet seen, w (w + 1)/(n - w - 2) after n searches that found
/// w (Boender and Rinnooy Kan 1987, Math. Programming 37, 59-80), is below a half and every point within reach of the
/// highest density was followed. Fewer points where an evaluation takes long, by the number of observations and by
/// `LogDensity::is_slow`, never by time: the outcome is the same on any machine. `known` stays the first unless another has more
/// than e times its mass.
Maxima find_maxima(const Posterior& posterior, const Mode& known);

/// A sentence for the check of the computation, with the parameters in their units: "12 starts found one maximum"; "24 starts:
/// 2 maxima, at th = 2.01 (88 %) and th = -2.00 (12 %)".
std::string description(const Posterior& posterior, const Maxima& maxima);

}  // namespace wearwell
