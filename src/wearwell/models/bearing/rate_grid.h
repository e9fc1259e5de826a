#pragma once

#include <optional>

#include "wearwell/models/bearing/inspected.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/node_tracker.h"

namespace wearwell::bearing {

/// The inspections of one bearing: those that the posterior has, and all.
struct BearingRows {
  std::optional<Inspected> seen, all;  ///< none where there is no row
};

/// A bearing's own ln k (and sigma, where that is not known) as nodes, a row each. Points of the population's posterior
/// are put into classes of sigma; in each class ln k stands on even places, and the weight of a place u is
///
///   sum_x w(x) N(u; ln k, k_scatter) L_all(u, sigma) / L_seen(x)
///
/// over the points of the class, L_seen with its integral over u. Where bearings are alike the points are the nodes.
struct RateGrid {
  prognosis::NodeCloud nodes;
  double effective = 0;  ///< points that carry the sum: 1 / sum of squares
};
RateGrid rate_grid(const WearModel& model, const ThinnedPosterior& points, const BearingRows& rows);

}  // namespace wearwell::bearing
