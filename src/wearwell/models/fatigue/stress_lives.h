#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::fatigue {

/// The lives of parts under one stress, for each of a posterior's points apart: their survival on a grid of log10 life, a
/// tenth of the least scatter apart, and coarser beyond the lives that are expected. Made once; what a part has survived
/// then only changes the weights of the points, w_i S_i(n)/S_i(known), and where their lives begin.
class StressLives {
 public:
  /// Nothing is known of points at which the law has no life under that stress: `undefined` is their weight, and
  /// they have no life at all, as in the likelihood.
  StressLives(const SnLaw& law, const ThinnedPosterior& points, const Stress& stress);

  /// Lives beyond that have no end, cycles.
  static constexpr double most_cycles = 1e15;

  double undefined() const { return undefined_; }

  /// log S_i(n)/S_i(known) of each point: minus infinity where it survives that never. `known` <= n [cycles] is what the
  /// posterior holds of the part; 0: nothing.
  std::vector<double> log_survival(double n, double known) const;

  /// Of parts that have survived n, what remains [cycles], infinite where life has no end: mixed over the points with
  /// these weights, which have the survival to n in them.
  prognosis::WeightedLives remaining(std::span<const double> weight, double n) const;

 private:
  std::vector<double> places_beyond(double n) const;
  double log_survival_at(std::size_t point, double log10_life) const;

  std::size_t points_ = 0;
  double undefined_ = 0;
  std::vector<double> at_;   // log10 of cycles, rising
  std::vector<double> log_;  // log survival: by point, by place
  std::vector<double> endless_;
};

}  // namespace wearwell::fatigue
