#pragma once

#include <span>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// The points of a posterior at which curves are computed: its nodes, with those below 3e-7 of the
/// weight merged; with a random limit, which needs an integral at each point, `most_with_limit`.
WeightedDraws curve_nodes(const SnLaw& law, const WeightedDraws& posterior,
                          Eigen::Index most_with_limit);

/// Lives under one stress at each point of a posterior. The model and the draws must outlive it.
class LivesUnder {
 public:
  LivesUnder(const SnLaw& law, const WeightedDraws& draws, const Stress& stress);

  /// The life that this share outlasts at each point, 0 < reliability < 1, on the scale on which
  /// lives scatter.
  std::vector<double> at_points(double reliability) const;

  /// The same, on the scale on which lives scatter: at each `level` the quantile over the
  /// posterior. NaN if some point has none.
  std::vector<double> outlasted(double reliability, std::span<const double> levels) const;

 private:
  const SnLaw& law_;
  const WeightedDraws& draws_;
  Stress stress_;
  std::vector<double> center_, sigma_;  // without a random limit nothing else matters
};

}  // namespace wearwell::fatigue
