#pragma once

#include <optional>
#include <span>

#include "wearwell/prognosis/change_cause.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// The columns of a reading that tell of a change.
struct WatchedColumns {
  std::size_t axis = 0;
  std::optional<std::size_t> level;     ///< measures the quantity with the threshold
  std::optional<std::size_t> measured;  ///< `level`, or the only measured one
};
WatchedColumns watched_columns(const Tracker& tracker);

/// The reading without its measured values but the watched one.
Reading alone(const Tracker& tracker, const WatchedColumns& watched, Reading reading);

/// The size of a plausible difference of the watched value `measured`: a hundredth of the threshold
/// where that is of its kind, else of the value.
double scale_of_reading(const Tracker& tracker, const WatchedColumns& columns, double measured);

/// Fills `expected` and `spread` of the watched value of a reading, to a twentieth of `scale`, SI;
/// false if nothing predicts it.
bool predict(const TrackedUnit& unit, const Reading& reading, const WatchedColumns& columns,
             double scale, ReadingSince& values);

/// The p-value of a reading on both sides; of several values the smallest one times their number. NaN
/// without tails.
double two_sided(std::span<const PredictiveTails> tails);

}  // namespace wearwell::prognosis
