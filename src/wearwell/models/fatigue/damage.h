#pragma once

#include <optional>
#include <vector>

#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// Cycles of one stress, Pa.
struct LoadCycle {
  Stress stress;
  double count = 0;
};
using LoadCycles = std::vector<LoadCycle>;

/// Damage accumulation: each cycle takes 1/N of the life, with N from the S-N curve, and below its
/// knee
///
///   original    no damage (Palmgren 1924, Miner 1945)
///   elementary  as without a knee
///   haibach     with a slope of 2k - 1 (Haibach 1970)
///   liu_zenner  with a line of slope (k + 3.6)/2 through the curve at the largest stress of the
///               history, down to half of the knee's stress, and no damage below (Liu and Zenner
///               1992)
///
/// where k = -1/b is the curve's slope.
enum class MinerRule { original, elementary, haibach, liu_zenner };

/// The knee of the curve: at a number of cycles, or at a fully reversed amplitude [Pa].
struct Knee {
  std::optional<double> life, stress;
  bool any() const { return life || stress; }
};

struct DamageRule {
  MinerRule miner = MinerRule::elementary;
  Knee knee = {};
};

/// The damage of one block of cycles, for one point x of the posterior. Items vary: one at score z
/// of the standard distribution of lives has the life of the curve times 10^(sigma z), at every
/// stress. Only for distributions on a logarithmic scale (SnLaw::logarithmic), of which it keeps a
/// copy; `x` must outlive it.
class BlockDamage {
 public:
  BlockDamage(const SnLaw& law, const double* x, const DamageRule& rule, const LoadCycles& cycles);

  /// log10 of the damage to an item at score z; with a random fatigue limit at score `limit` of its
  /// distribution. -infinity if no cycle does damage, infinity if one reaches the strength.
  double log10_damage(double z, double limit = 0) const;

  /// Each cycle's share of the damage to the item at score 0, in the order of the cycles; all 0 if
  /// there is no damage.
  std::vector<double> shares(const LoadCycles& cycles) const;

 private:
  void add_lives();
  double log10_damage_of_lives(double z, double limit) const;
  double knee(double z) const;
  double log10_damage_of_one(double log10_reversed, double knee_at) const;

  SnLaw law_;
  const double* x_;
  DamageRule rule_;
  double slope_, below_slope_ = 0;  // above and below the knee
  std::vector<double> given_;       // log10 of the reversed stress, in the order of the cycles
  std::vector<double> log10_reversed_, count_;  // from the largest stress down
  std::vector<double> above_, below_;           // running sums by the two slopes
  std::vector<double> life_;                    // log10, for a curved S-N line
  double top_ = 0;
  bool fatal_ = false;
};

}  // namespace wearwell::fatigue
