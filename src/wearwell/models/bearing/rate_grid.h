#pragma once

#include <optional>

#include "wearwell/models/bearing/inspected.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/node_tracker.h"

namespace wearwell::bearing {

/// The inspections of one bearing: those in the posterior, and all.
struct BearingRows {
  std::optional<Inspected> seen, all;  ///< empty if there is no row
};

/// A bearing's ln k (and sigma, if it is unknown) as nodes, one row each. Points of the
/// population's posterior are grouped into classes of sigma; in each class ln k has even places,
/// and the weight of a place u is
///
///   sum_x w(x) N(u; ln k, k_scatter) L_all(u, sigma) / L_seen(x)
///
/// over the points of the class, where L_seen includes its integral over u. If bearings do not vary
/// the points are the nodes.
struct RateGrid {
  prognosis::NodeCloud nodes;
  double effective = 0;  ///< effective number of points in the sum: 1 / sum of squares
};
RateGrid rate_grid(const WearModel& model, const ThinnedPosterior& points, const BearingRows& rows);

}  // namespace wearwell::bearing
