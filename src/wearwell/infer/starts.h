#pragma once

#include <Eigen/Dense>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// A start of a search, with its log density.
struct StartPoint {
  Eigen::VectorXd z;  ///< on the real line
  double log_density = 0;
};

/// The starts of a search for maxima (maxima.h).
struct StartPoints {
  std::vector<StartPoint> high;   ///< higher than all of their neighbours, highest first
  std::vector<StartPoint> plain;  ///< unselected points of the prior's mass
};

/// About `count` quasi-random points: half of them in the prior's mass, a quarter about the start
/// values, a quarter about the middle of `known`.
StartPoints start_points(const Posterior& posterior, const Whitening& known, int count);

}  // namespace wearwell
