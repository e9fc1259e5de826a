#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// A sequential test of one unit: whether its readings still follow their predictions.
///
/// The normal score z of a reading's predictive probability is standard normal, independent of the
/// earlier ones, if the unit is one of its population (Dawid 1984, prequential). Against that, ten
/// alternatives bet on each reading: a shift of z by 0.5, 1, 2 or 4 in either direction, more
/// scatter, and repeated equal values. Each bet is an e-value (its mean is at most 1), and its
/// products from reading k on, weighted over k with weights that sum to 1, form a test martingale
/// (Shafer and Vovk 2019; Ramdas et al. 2023). By Ville's inequality the weighted sum of a right
/// unit ever reaches 1000 with a probability of at most 1/1000: in its whole life, for any number
/// of readings. See docs/explanation/tracking.md.
class ChangeTest {
 public:
  static constexpr double begins = 1000;  ///< evidence at which doubt begins
  static constexpr double ends = 10;      ///< evidence below which it ends
  static constexpr double some = 1;       ///< less is no evidence

  /// The next reading: its tails, and the e-value of `repeat_evidence` (1: not tested). Several
  /// measured values count by the mean of their e-values. Without tails only the second counts.
  void add(std::span<const PredictiveTails> tails, double repeat = 1);

  bool in_doubt() const { return in_doubt_; }
  /// The evidence of a change at some reading.
  double evidence() const;
  std::uint64_t readings() const { return readings_; }

  void save(ByteWriter& to) const;
  void load(ByteReader& from);

 private:
  static constexpr std::size_t alternatives = 10;
  std::uint64_t readings_ = 0;
  std::array<double, alternatives> sums_ = {};  ///< over changes so far, by alternative
  bool in_doubt_ = false;
};

/// The e-value of a reading that equals the one before, `probability` being its predictive
/// probability to do so, and of one that differs.
double evidence_of_repeat(double probability);
double evidence_of_difference();

}  // namespace wearwell::prognosis
