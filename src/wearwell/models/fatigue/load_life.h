#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "wearwell/models/fatigue/damage.h"
#include "wearwell/models/fatigue/damage_sum.h"
#include "wearwell/models/fatigue/sn_result.h"

namespace wearwell::fatigue {

struct LoadQuestion {
  DamageRule rule = {};
  DamageSum sum = {};
  std::vector<double> percents = {1, 10, 50};  ///< of the B-lives
  double confidence = 0.9;                     ///< of lower bounds
};

/// The life at which a percentage of all items has failed, with its uncertainty, in blocks.
struct BlockLife {
  double percent = 0;
  double q05 = 0, q50 = 0, q95 = 0;
  double bound = 0;  ///< exceeded with the confidence
  double next = 0;   ///< of the next item, averaged over all uncertainty
};

/// Of the variance of log10 life.
struct Contribution {
  std::string name;
  double share = 0;
};

/// Damage and life under a history, over posterior, scatter of items and damage sum. Infinite if
/// nothing does damage.
struct LoadLife {
  std::vector<BlockLife> lives;
  double next05 = 0, next50 = 0, next95 = 0;        ///< life of the next item, blocks
  double damage05 = 0, damage50 = 0, damage95 = 0;  ///< of one block, to the next item
  std::vector<std::pair<double, double>> cdf;       ///< log10 of blocks, probability: the next item
  double sd = 0;                                    ///< of log10 life
  std::vector<Contribution> contributions;          ///< empty if some items never fail
  /// Shares of the damage, averaged over the posterior: by cycles with a alternating stress above
  /// and below the tested range, and with a mean stress outside it.
  double above = 0, below = 0, beyond_mean = 0;
  std::vector<double> shares;  ///< of the damage, by each of the cycles
  std::size_t draws = 0;       ///< points of the posterior
};

/// The number of cycles must be small (load_cycles.h, reduced). Throws InputError for a
/// distribution for which damage cannot be summed, or a rule that needs a knee; Cancelled.
LoadLife load_life(const SnResult& result, const LoadCycles& cycles, const LoadQuestion& question,
                   const std::stop_token& stop = {});

/// Shares of the variance of `y` at weighted points due to the columns of their values, which may
/// depend on each other: Shapley values of the best linear predictors (Song, Nelson and Staum
/// 2016), and last the part that no linear predictor explains. They sum to 1.
std::vector<double> variance_shares(const WeightedDraws& x, const Eigen::VectorXd& y);

}  // namespace wearwell::fatigue
