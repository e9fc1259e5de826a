#pragma once

#include <span>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// The points of a posterior at which curves are computed: its nodes, those of less than 3e-7 of the weight gathered; with a
/// limit that scatters, an integral at each point, `most_with_limit`.
WeightedDraws curve_nodes(const SnLaw& law, const WeightedDraws& posterior,
                          Eigen::Index most_with_limit);

/// Lives under one stress at each point of a posterior. Law and draws must outlive it.
class LivesUnder {
 public:
  LivesUnder(const SnLaw& law, const WeightedDraws& draws, const Stress& stress);

  /// The life that such a share outlasts at each point, 0 < reliability < 1, on the scale on which lives scatter.
  std::vector<double> at_points(double reliability) const;

  /// The same, on the scale on which lives scatter: at each `level` the quantile
  /// over the posterior. NaN where some point has none.
  std::vector<double> outlasted(double reliability, std::span<const double> levels) const;

 private:
  const SnLaw& law_;
  const WeightedDraws& draws_;
  Stress stress_;
  std::vector<double> center_, sigma_;  // without a limit that scatters nothing else matters
};

}  // namespace wearwell::fatigue
