#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/maxima.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/tail.h"

namespace wearwell {

/// Where a posterior's mass lies, before it is integrated or drawn from.
struct PosteriorShape {
  Mode mode;                ///< on the real line
  std::vector<Tail> tails;  ///< about the mode
  double highest;           ///< log density met anywhere
  int neck = -1;  ///< the scale of a funnel (funnel.h): then the mode is the middle of the mass
  Maxima maxima = {};  ///< of a posterior whose tails can be integrated
};

/// Looks for the mode, the tails and other maxima. Where there is no mode the shape is that about the middle of the mass; other
/// maxima of an improper posterior do not matter.
PosteriorShape posterior_shape(const Posterior& posterior);

}  // namespace wearwell
