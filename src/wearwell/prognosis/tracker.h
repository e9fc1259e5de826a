#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::prognosis {

/// A value of a reading.
struct ReadingColumn {
  std::string name;       ///< the study's name: "force"
  Unit unit;              ///< of the study
  bool measured = false;  ///< an observed quantity; else a condition of the observation
  bool carried = false;   ///< if a reading has none, that of the reading before holds
};

/// One reading of one unit: a row of the study's table. Order of columns: `Tracker::columns`,
/// `labels`.
struct Reading {
  std::vector<double> numbers;      ///< SI; NaN if missing in the reading
  std::vector<std::string> labels;  ///< of the study's label columns except the unit's own
};

/// The place of a measured value in its predictive distribution, given the unit's earlier readings.
/// The two sum to 1, and to more where the value has a probability of its own (a count, a part that
/// has survived).
struct PredictiveTails {
  double below = 0;  ///< P(Y <= y)
  double above = 0;  ///< P(Y >= y)
};

/// The outcome of a reading.
struct UpdateResult {
  bool counted = false;      ///< the state has changed
  bool contradicts = false;  ///< counted, but hardly possible given the unit's earlier readings
  /// Predictive p-value, two-sided; below 1e-4 the reading contradicts. 1 for a late reading where
  /// rows depend on earlier ones.
  double p_value = 0;
  std::string problem = {};  ///< why it was not counted: "force is missing"
  /// Of each measured value of the reading. Empty where there is no prediction: censored values, a
  /// late reading where rows depend on earlier ones.
  std::vector<PredictiveTails> tails = {};
  bool impossible = false;  ///< not counted: it has probability 0 for every unit of the population
};

/// Whether the rate of a unit has changed, in a study that allows for it (docs/how-to/rate-change.md).
struct RateChange {
  double probability = 0;  ///< that it has
  /// If it has: the place on the axis since which the new rate holds, SI, and the new rate as a
  /// multiple of the earlier one; quantiles of 5, 50 and 95 %. NaN before the first reading.
  double since05 = 0, since50 = 0, since95 = 0;
  double factor05 = 0, factor50 = 0, factor95 = 0;
};

/// The forecast of a unit now: SI along the axis.
struct Forecast {
  double now = 0;  ///< position of its farthest reading
  /// the quantity with the threshold (wear) there, SI
  double level05 = 0, level50 = 0, level95 = 0;
  double passed =
      /// the probability that it has passed the threshold; NaN if nothing determines how it
      /// continues
      0;
  WeightedLives remaining;  ///< from `now` on, given that it has not
  double effective = 0;     ///< effective sample size of the nodes: 1 / sum of squares
  /// Of a study that allows for a change; then `remaining` includes future changes.
  std::optional<RateChange> rate_change = {};
};

/// A forecast as three quantiles of each quantity, SI.
struct ForecastQuantiles {
  double now = 0;  ///< Forecast::now
  double level05 = 0, level50 = 0, level95 = 0;
  double passed = 0;                                         ///< Forecast::passed
  double remaining05 = 0, remaining50 = 0, remaining95 = 0;  ///< 0 if it has certainly passed
};
ForecastQuantiles quantiles_of(const Forecast& forecast);

/// The forecast of a unit given each possible population (`Tracker::populations`), in their order.
/// Units share only the population: given it they are independent.
struct InPopulations {
  std::vector<double>
      log_likelihood;          ///< of all readings of the unit since the study, up to a constant
  std::vector<double> passed;  ///< Forecast::passed
  std::vector<WeightedLives> remaining;  ///< Forecast::remaining
};

/// The quantity with the threshold at a future position, SI: quantiles over the uncertainty of the
/// unit, and over future increments where these are random. NaN where too much of it is not a
/// number.
struct ForecastBand {
  double at = 0;  ///< along the axis
  double level05 = 0, level50 = 0, level95 = 0;
};

/// Moves the levels by this, SI.
template <class Levels>
void move_levels(Levels& of, double by) {
  for (double* each : {&of.level05, &of.level50, &of.level95}) *each += by;
}

/// Positions that show how a unit continues: from `now` to the median of its remaining useful life
/// and on to the 95 % quantile, in even steps each. If fewer reach the threshold, to the farthest
/// finite quantile; if none does, as far again as the unit has come. Empty if the threshold is
/// certainly passed, or nothing determines the range.
std::vector<double> places_ahead(const Forecast& forecast, std::size_t count = 24);

/// All readings of a unit that were counted so far, in the order in which they were taken; needed
/// when nodes are rebuilt. Calls back once a reading.
using History = std::function<void(const std::function<void(const Reading&)>& visit)>;

/// One tracked unit: weights over fixed nodes, so that a reading multiplies them and the order of
/// arrival does not matter. A sequence of readings gives the same bits at any time, on any machine,
/// and from a saved state.
///
/// One thread at a time, except for const functions; different units may run in parallel.
class TrackedUnit {
 public:
  virtual ~TrackedUnit() = default;
  /// Processes a new reading; the caller detects repeated ones. `history` has all readings taken
  /// before this one.
  virtual UpdateResult update(const Reading& reading, const History& history) = 0;
  virtual Forecast forecast() const = 0;
  /// Those of `forecast` (to rounding), perhaps at a fraction of its cost.
  virtual ForecastQuantiles quantiles() const { return quantiles_of(forecast()); }
  /// The tails that `update` would find for a reading, without taking it. Empty if the reading is
  /// invalid, or as for `UpdateResult::tails`.
  virtual std::vector<PredictiveTails> predictive(const Reading& reading) const = 0;
  /// The forecast band at these positions, ascending, none before the unit's present position; a
  /// path that passes the threshold continues. More expensive than a forecast.
  virtual std::vector<ForecastBand> ahead(std::span<const double> places) const = 0;
  /// The same forecast by population; more expensive than a forecast. Empty if only the mixture is
  /// available: for a model that does not distinguish populations, or a unit whose rebuilt nodes no
  /// longer belong to the common populations.
  virtual std::optional<InPopulations> in_populations(const History& history) const {
    static_cast<void>(history);
    return {};
  }
  /// What repairs have taken back of the quantity with the threshold, SI, as an amount above 0.
  /// Readings come with it added again, so that they go on from those before: it moves the threshold
  /// and the reported levels. Not part of the saved state. Only if `Tracker::can_be_restored`.
  virtual void set_restored(double amount) { static_cast<void>(amount); }
  virtual std::size_t readings() const = 0;
  virtual std::string save() const = 0;  ///< bytes for `Tracker::restore`
};

/// The tracker for units of a fitted population: made once, shared by all threads, never changed.
class Tracker {
 public:
  virtual ~Tracker() = default;
  virtual std::span<const ReadingColumn> columns() const = 0;
  virtual std::span<const std::string> labels() const = 0;
  virtual const ReadingColumn& axis() const = 0;   ///< axis of life; one of the columns
  virtual const std::string& limited() const = 0;  ///< the quantity with the threshold: "wear"
  virtual const Quantity& limit() const = 0;
  virtual bool rising() const = 0;              ///< whether the threshold is reached from below
  virtual const std::string& noun() const = 0;  ///< noun for a unit: "machine"
  /// Bound on the error of a probability in a forecast's distributions, as tests verify
  /// (docs/explanation/tracking.md).
  virtual double probability_error() const = 0;
  /// Weights of the possible populations, as the study left them; sum to 1. Empty: not
  /// distinguished.
  virtual std::vector<double> populations() const { return {}; }
  /// The units of the study.
  virtual std::span<const std::string> seen() const = 0;
  /// Why a unit of that name is invalid; empty if it is valid: a study of one joint has only that
  /// joint.
  virtual std::string refusal(const std::string& /*unit*/) const { return {}; }
  /// Whether a unit can go on after a repair that takes back a part of its wear.
  virtual bool can_be_restored() const { return false; }
  /// Why a reading is invalid for every unit, whatever it has shown; empty if it is valid.
  virtual std::string problem(const Reading& reading) const = 0;
  /// A unit before its first new reading: one of the study's, with its readings there, or a new
  /// one.
  virtual std::unique_ptr<TrackedUnit> begin(const std::string& unit) const = 0;
  /// Throws InputError if the bytes are of another population or damaged.
  virtual std::unique_ptr<TrackedUnit> restore(const std::string& bytes) const = 0;
};

}  // namespace wearwell::prognosis
