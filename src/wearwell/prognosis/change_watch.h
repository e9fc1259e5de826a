#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "wearwell/prognosis/change_cause.h"
#include "wearwell/prognosis/change_test.h"
#include "wearwell/prognosis/factor_test.h"
#include "wearwell/prognosis/population_test.h"
#include "wearwell/prognosis/predicted_reading.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// A unit under watch, and what it belongs to.
struct WatchedUnit {
  const Tracker& tracker;
  const WatchedColumns& columns;
  const std::string& name;
  TrackedUnit& unit;
  double restored = 0;  ///< as in `TrackedUnit::set_restored`
  /// Of this reading, SI: what is added to the measured level, as repairs took it back (below 0 where the
  /// level falls), and what is subtracted, as the sensor shows too much. Reasons quote levels that are
  /// measured: without `added`.
  double added = 0, offset = 0;
};

/// Watches whether a unit still follows its forecasts, and describes what has changed. Like the
/// unit's state it follows from the readings in their order.
class ChangeWatch {
 public:
  /// Gives the unit its next reading. `late`: taken before one that the unit has already.
  /// `history`: all readings before it, counted or not, in their order.
  UpdateResult update(const WatchedUnit& of, const Reading& reading, bool late,
                      const History& history);

  /// Whether the forecast is in doubt.
  bool in_doubt() const {
    return is_changed() || is_back() || population_.is_outside() || factor_.is_found();
  }
  /// Why, without a capital and a full stop; empty if it is not in doubt.
  const std::string& reason() const { return reason_; }
  /// Whether the last reading in order measures a level beyond the threshold.
  bool is_beyond() const { return beyond_; }
  const ChangeTest& test() const { return test_; }

  void save(ByteWriter& to) const;
  void load(ByteReader& from, const Tracker& tracker);

 private:
  /// A reading while there is evidence of a change.
  struct Since {
    Reading reading;
    ReadingSince values;
    bool predicted = false;  ///< `values.expected` and `spread` are known
  };

  bool is_changed() const { return test_.in_doubt() || held_; }
  bool is_back() const { return last_at_ < farthest_at_; }
  double repeat_evidence(const WatchedUnit& of, const Reading& reading) const;
  void hold(const WatchedUnit& of, const Reading& reading, const History& history);
  void note_values(const WatchedUnit& of, const Reading& reading);
  void note_evidence(const WatchedUnit& of, const Reading& reading, double before_at);
  std::string described(const WatchedUnit& of, const History& history);
  std::string described_change(const WatchedUnit& of, const History& history);
  std::optional<std::vector<ReadingSince>> predicted(const WatchedUnit& of, const History& history);
  std::vector<ReadingSince> predicted_as_new(const WatchedUnit& of, std::size_t first,
                                             double start);
  bool find_reference(const WatchedUnit& of, const History& history);

  static constexpr double none = -std::numeric_limits<double>::infinity();
  ChangeTest test_;
  PopulationTest population_;
  FactorTest factor_;
  bool held_ = false;           // the test has ended, but readings do not agree with those before
  std::uint64_t agreeing_ = 0;  // readings in a row that do
  std::string reason_;
  std::uint64_t taken_ = 0;  // all readings: those of `history`
  double last_at_ = none, farthest_at_ = none;
  bool beyond_ = false;

  double last_value_ = std::numeric_limits<double>::quiet_NaN();
  double last_added_ = 0, last_offset_ = 0;                    // of it, as in WatchedUnit
  double coarsest_ = std::numeric_limits<double>::infinity();  // step of the readings, at most
  double repeats_ = 1;       // evidence of the present run of equal readings
  std::uint64_t equal_ = 0;  // the last readings with one value

  std::deque<Since> since_;    // the last ones
  std::uint64_t dropped_ = 0;  // earlier ones of them
  std::uint64_t before_ = 0;   // readings before them
  double before_at_ = none;    // where the last one before them was
  /// A new unit with the readings since a change.
  struct NewUnit {
    std::unique_ptr<TrackedUnit> unit;
    std::vector<Reading> taken = {};
    std::vector<ReadingSince> values = {};
    std::size_t first = 0;
    double start = 0;
  };

  // Neither of these is saved, but found again from the readings.
  std::shared_ptr<NewUnit> new_unit_;
  // The unit as it was before them.
  std::shared_ptr<const TrackedUnit> reference_;
};

}  // namespace wearwell::prognosis
