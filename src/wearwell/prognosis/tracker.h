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

/// A number that a reading may bring.
struct ReadingColumn {
  std::string name;       ///< as the study names it: "force"
  Unit unit;              ///< of the study
  bool measured = false;  ///< what is observed; else a condition under which it was
};

/// One reading of one unit: a row of the study's table. Order of columns: `Tracker::columns`, `labels`.
struct Reading {
  std::vector<double> numbers;      ///< SI; NaN where the reading does not bring it
  std::vector<std::string> labels;  ///< of the study's label columns but the unit's own
};

/// What became of a reading.
struct UpdateResult {
  bool counted = false;      ///< the state has moved
  bool contradicts = false;  ///< counted, but hardly possible given what the unit showed before
  /// Its place in its predictive distribution: a two-sided probability; below 1e-4 it contradicts. 1 of a
  /// reading that was late where rows depend on those before.
  double p_value = 0;
  std::string problem = {};  ///< why it was not counted: "force is missing"
};

/// What is known of a unit now: SI along the axis.
struct Forecast {
  double now = 0;                                ///< where its farthest reading lies
  double level05 = 0, level50 = 0, level95 = 0;  ///< what the limit is of, there (wear), SI
  double passed =
      0;  ///< the probability that the limit is behind it; NaN where nothing says how it goes on
  WeightedLives remaining;  ///< from `now` on, given that it is not
  double effective = 0;     ///< nodes that carry this: 1 / sum of squares
};

/// What is known of a unit if its population is one or another of those that are possible (`Tracker::populations`), in their
/// order. Units share the population and nothing else: given it they are independent.
struct InPopulations {
  std::vector<double>
      log_likelihood;          ///< of all that the unit showed since the study, up to a constant
  std::vector<double> passed;  ///< Forecast::passed
  std::vector<WeightedLives> remaining;  ///< Forecast::remaining
};

/// What the limit is of at a place ahead, SI: quantiles over all that is not known of the unit, and over
/// the chance to come where increments are random. NaN where too much of it is no number there.
struct ForecastBand {
  double at = 0;  ///< along the axis
  double level05 = 0, level50 = 0, level95 = 0;
};

/// Places that show how a unit goes on: from `now` to the median of its remaining useful life and on to the 95 %
/// quantile, in even steps each. Where the limit is reached by fewer, to the farthest quantile that there is;
/// where it never is, as far again as the unit has come. Empty where the limit certainly is behind, or nothing
/// says how far to look.
std::vector<double> places_ahead(const Forecast& forecast, std::size_t count = 24);

/// All readings of a unit that were counted so far, in the order in which they were taken: asked for where
/// nodes are laid anew. Calls back once a reading.
using History = std::function<void(const std::function<void(const Reading&)>& visit)>;

/// One unit on line: weights over nodes that do not move, so that a reading multiplies them and the order of
/// arrival does not matter. A sequence of readings gives the same bits whenever and wherever it is taken, and
/// from a saved state on.
///
/// One thread at a time, but for functions that are const; different units on as many as there are.
class TrackedUnit {
 public:
  virtual ~TrackedUnit() = default;
  /// Takes a reading that was not taken before; a repeated one is the caller's to find. `history` has all
  /// readings taken before this one.
  virtual UpdateResult take(const Reading& reading, const History& history) = 0;
  virtual Forecast forecast() const = 0;
  /// The path ahead at these places, ascending, none before where the unit is now: whatever becomes of it, so
  /// a path that has passed the limit goes on. Dearer than a forecast.
  virtual std::vector<ForecastBand> ahead(std::span<const double> places) const = 0;
  /// The same forecast population by population; dearer than a forecast. Nothing where only that is at hand: of a model that
  /// does not take them apart, or of a unit whose readings left the populations behind that all have in common.
  virtual std::optional<InPopulations> in_populations(const History& history) const {
    static_cast<void>(history);
    return {};
  }
  virtual std::size_t readings() const = 0;
  virtual std::string save() const = 0;  ///< bytes for `Tracker::restore`
};

/// What tracks the units of a population that a study has learned: made once, shared by all threads, never
/// changed.
class Tracker {
 public:
  virtual ~Tracker() = default;
  virtual std::span<const ReadingColumn> columns() const = 0;
  virtual std::span<const std::string> labels() const = 0;
  virtual const ReadingColumn& axis()
      const = 0;  ///< along which life is counted; one of the columns
  virtual const std::string& limited() const = 0;  ///< what the limit is of: "wear"
  virtual const Quantity& limit() const = 0;
  virtual bool rising() const = 0;              ///< whether the limit is reached from below
  virtual const std::string& noun() const = 0;  ///< what a unit is: "machine"
  /// How far a probability in the distributions of a forecast may be off: what tests hold them to (docs/explanation/tracking.md).
  virtual double probability_error() const = 0;
  /// Weights of the populations that are possible, as the study left them; sum to 1. None: not told apart.
  virtual std::vector<double> populations() const { return {}; }
  /// The units that the study has seen.
  virtual std::span<const std::string> seen() const = 0;
  /// Why there can be no unit of that name; empty where there can be: of a study of one joint there is that one.
  virtual std::string refusal(const std::string& /*unit*/) const { return {}; }
  /// A unit before its first reading here: one of the study's, with what it showed there, or a new one.
  virtual std::unique_ptr<TrackedUnit> begin(const std::string& unit) const = 0;
  /// Throws InputError where the bytes are of another population or damaged.
  virtual std::unique_ptr<TrackedUnit> restore(const std::string& bytes) const = 0;
};

}  // namespace wearwell::prognosis
