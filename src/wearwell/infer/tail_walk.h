#pragma once

#include <optional>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/mode.h"
#include "wearwell/infer/tail.h"

/// The walk outward along the ridge of one parameter, from which its tail is measured (tail.h).
namespace wearwell {

/// A fitted index of 2.03 counts as 2, because slopes are measured at a finite distance.
inline constexpr double tail_slack = 0.05;

/// The walk ends at the resolution of doubles: e^40 times the start, or e^20 widths away on a whole
/// line.
inline constexpr double far_log = 40;
inline constexpr int walk_steps = 20;

/// A parameter along which the density rises beyond that of the mode, out of reach: without a proper
/// prior its integral is infinite. `slope` is that of the log density on the real line.
struct Escape {
  int parameter = 0;
  bool outward = true;  ///< on the real line
  double slope = 0;
};

/// The stations of the walk: logarithms of the distance (from 0, or to the bound), of the
/// parameter's marginal density, and of the likelihood.
struct Walk {
  std::vector<double> log_distance, log_density, log_likelihood;
  std::vector<bool> converged;   ///< whether the conditional mode exists
  bool lost = false;             ///< the conditional mode or finite numbers were lost
  bool vanished = false;         ///< the density vanished
  bool left = false;             ///< another parameter left the range
  std::optional<Escape> escape;  ///< if it left towards a higher density than that of the mode

  std::size_t stations() const { return log_density.size(); }
  /// Without the stations that have no conditional mode.
  Walk sound() const;
  /// From the far half, or from a station on: the median of slopes between neighbours, which is robust
  /// against a bad station. `may_slow`: for a tail towards infinity under improper priors.
  double index(bool may_slow) const;
  double index_from(std::size_t first, bool may_slow) const;
  bool likelihood_grows() const;
};

/// The marginal width of coordinate i at the mode: the first step on a whole line.
double width_at(const Mode& mode, int i);

/// Walks along the ridge of `tail.parameter`, and notes its highest density there. `to_the_end`: continues after the
/// density has vanished.
Walk walk_along(const Posterior& posterior, const Mode& mode, Tail& tail, bool outward,
                bool to_the_end);

}  // namespace wearwell
