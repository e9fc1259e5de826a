#pragma once

#include <optional>
#include <vector>

#include "wearwell/prognosis/change_watch.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// Three quantiles; infinite if a threshold is never reached.
struct Interval {
  double q05 = 0, q50 = 0, q95 = 0;
};

/// Conversion of a tracker's values to the units of its study.
class TrackerUnits {
 public:
  /// The tracker must outlive it.
  explicit TrackerUnits(const Tracker& tracker);

  const Tracker& tracker() const { return tracker_; }
  const WatchedColumns& watched() const { return watched_; }

  double at(double si) const { return from_si(axis_, si); }
  double along(double si) const { return si / axis_.scale; }  ///< a length of the axis
  double level(double si) const { return from_si(level_, si); }
  Interval level(const ForecastQuantiles& forecast) const;
  Interval level(const Forecast& forecast) const;
  /// From now on; infinite if it may never be.
  Interval remaining(const ForecastQuantiles& forecast) const;
  Interval remaining(const Forecast& forecast) const;
  /// Remaining useful life that 90 % exceed.
  double b10(const Forecast& forecast) const;
  /// Since when the rate has changed, and its factor, if it has.
  Interval since(const RateChange& change) const {
    return {at(change.since05), at(change.since50), at(change.since95)};
  }
  static Interval factor(const RateChange& change) {
    return {change.factor05, change.factor50, change.factor95};
  }
  /// Of a reading: the measured value of the quantity with the threshold, if it is measured.
  std::optional<double> measured(const std::vector<double>& numbers) const;

 private:
  const Tracker& tracker_;
  Unit axis_, level_;
  WatchedColumns watched_;
};

/// The probability that the threshold is reached within `horizon` (SI) from now on.
double risk_within(const Forecast& forecast, double horizon);

}  // namespace wearwell::prognosis
