#pragma once

#include <Eigen/Dense>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// A place where a search may start, and how high it is.
struct StartPoint {
  Eigen::VectorXd z;  ///< on the real line
  double log_density = 0;
};

/// Where searches of a posterior start (maxima.h).
struct StartPoints {
  std::vector<StartPoint> high;   ///< higher than all of their neighbours, the highest first
  std::vector<StartPoint> plain;  ///< of the prior's mass, one as the other
};

/// About `count` quasi-random points: half of them in the prior's mass, a quarter about the start values, a quarter about
/// the middle of `known`.
StartPoints start_points(const Posterior& posterior, const Whitening& known, int count);

}  // namespace wearwell
