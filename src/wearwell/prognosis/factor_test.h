#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/change_cause.h"
#include "wearwell/prognosis/predicted_reading.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// Whether the readings of a unit are in another unit of measurement than the study's, from the
/// first on. A population of few units may not exclude one that wears a thousandth as fast, and the
/// forecast follows its readings; but they scatter a thousandth as much, too. Against that, each
/// factor of unit_factors() bets on a reading: the density of the reading times the factor, given
/// the earlier ones times the factor, over that of the reading as it is, given the earlier ones. Of
/// a right unit the mean of each is 1, so their products average to a test martingale, which ever
/// reaches 10,000 with a probability of at most 1e-4 (Ville).
///
/// A sensor that scatters less than the study's is right. So a factor bets only after a reading that
/// the population, too, makes ten times as probable with it, and none where 0 is a possible
/// reading of a new unit (p-value of 0.1). One that makes a reading a hundredth as probable is out.
class FactorTest {
 public:
  /// The next reading in its order; `unit` has not taken it yet. `added` as in WatchedUnit: with the
  /// first repair the test ends.
  void add(const Tracker& tracker, const WatchedColumns& columns, const std::string& name,
           const TrackedUnit& unit, const Reading& reading, double added);

  bool is_found() const { return !reason_.empty(); }
  const std::string& reason() const { return reason_; }

  void save(ByteWriter& to) const;
  void load(ByteReader& from, const Tracker& tracker);

 private:
  static constexpr std::size_t count = unit_factor_count;
  struct Other {
    double log_evidence = 0;
    bool is_nearer = false;  // the last reading is more probable with it
    /// A unit of the population with the readings times the factor; not saved, but found again.
    std::unique_ptr<TrackedUnit> unit = {};
  };

  static bool is_alive(const Other& other);
  void begin(Other& other, std::size_t factor, const Tracker& tracker, std::size_t column,
             const std::string& name);
  /// The first `until` of them times the factor. This must outlive it.
  History readings(std::size_t column, std::size_t factor, std::size_t until) const;
  void judge(const Tracker& tracker, std::size_t column, double last);

  bool ended_ = false;          // a factor is found, or none is left
  std::uint64_t seen_ = 0;      // readings
  std::vector<Reading> taken_;  // since the first bet
  std::array<Other, count> others_;
  std::string reason_;
};

}  // namespace wearwell::prognosis
