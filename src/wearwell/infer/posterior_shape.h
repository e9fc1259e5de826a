#pragma once

#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/maxima.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/tail.h"

namespace wearwell {

/// The location of a posterior's mass, before integration or sampling.
struct PosteriorShape {
  Mode mode;                ///< on the real line
  std::vector<Tail> tails;  ///< about the mode
  double highest;           ///< highest log density met
  int neck = -1;  ///< the scale of a funnel (funnel.h); the mode is then the middle of the mass
  Maxima maxima = {};  ///< for a posterior with integrable tails
};

/// Finds the mode, the tails and other maxima. Without a mode the shape is that about the middle of
/// the mass. Other maxima of an improper posterior are not searched.
PosteriorShape posterior_shape(const Posterior& posterior);

}  // namespace wearwell
