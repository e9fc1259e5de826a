#pragma once

#include <cstdint>
#include <string>

#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/predicted_reading.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// Whether a unit is one of its population at all. The forecast of a unit follows its own readings, so
/// a wrong unit from the first reading on, or a counter of use that began with an earlier part, is
/// soon forecast well. Here a reading is compared with those of a unit of the population that has shown
/// nothing yet (of the study's units: what the study shows). The k-th comparison is made at readings 1, 2, 3, 4, 6, 8, 12, 16,
/// ... and is significant below 1e-4 / (k (k + 1)), two-sided: of a right unit one ever is with a
/// probability of at most 1e-4, as these sum to 1e-4 (Bonferroni).
class PopulationTest {
 public:
  /// The next reading that counts, in its order; `added` as in WatchedUnit.
  void add(const Tracker& tracker, const WatchedColumns& columns, const std::string& unit,
           const Reading& reading, double added);

  /// Whether the last comparison was significant.
  bool is_outside() const { return !reason_.empty(); }
  const std::string& reason() const { return reason_; }

  void save(ByteWriter& to) const;
  void load(ByteReader& from);

 private:
  std::uint64_t readings_ = 0, comparisons_ = 0;
  std::string reason_;
};

}  // namespace wearwell::prognosis
