#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/models/fatigue/sn_law.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::fatigue {

/// The lives of parts under one stress, separately for each of a posterior's points: their survival
/// on a grid of log10 life, with steps of a tenth of the smallest scatter, and coarser beyond the
/// expected lives. Made once; survival of a part then only changes the weights of the points, w_i
/// S_i(n)/S_i(known), and the start of their lives.
class StressLives {
 public:
  /// At some points the model may have no life under that stress: `undefined` is their weight, and
  /// they are left out, as in the likelihood.
  StressLives(const SnLaw& law, const ThinnedPosterior& points, const Stress& stress);

  /// Lives beyond count as infinite, cycles.
  static constexpr double most_cycles = 1e15;

  double undefined() const { return undefined_; }

  /// log S_i(n)/S_i(known) of each point: minus infinity if it never survives that. `known` <= n
  /// [cycles] is what the posterior contains of the part; 0: nothing.
  std::vector<double> log_survival(double n, double known) const;

  /// The remaining life [cycles] of parts that have survived n, infinite if life has no end: mixed
  /// over the points with these weights, which include the survival to n.
  prognosis::WeightedLives remaining(std::span<const double> weight, double n) const;

 private:
  std::vector<double> places_beyond(double n) const;
  double log_survival_at(std::size_t point, double log10_life) const;

  std::size_t points_ = 0;
  double undefined_ = 0;
  std::vector<double> at_;   // log10 of cycles, ascending
  std::vector<double> log_;  // log survival: by point, by place
  std::vector<double> endless_;
};

}  // namespace wearwell::fatigue
