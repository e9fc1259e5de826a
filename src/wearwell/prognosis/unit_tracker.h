#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/prognosis/change_watch.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/prognosis/tracker_units.h"

namespace wearwell::prognosis {

/// The outcome of one row.
struct RowOutcome {
  bool repeated = false;  ///< equal to an earlier row; it counts once
  UpdateResult result = {};
};

/// One unit on line: its readings, its state, and the watch for changes, as the monitor has them
/// for a unit whose readings arrive in their order. One thread at a time.
class UnitTracker {
 public:
  /// `unit`: one of the study, which starts with its readings there; or with `fresh` a new one.
  /// Throws InputError that begins with "unit" if the study has no such unit, or has one though it
  /// is to be new.
  UnitTracker(std::shared_ptr<const Tracker> tracker, std::string unit, bool fresh);

  /// Takes the rows as readings in the order in which they were taken (reading_table.h); a column
  /// of units may only name this unit. All rows or none, whatever is thrown: InputError that names the first row that is
  /// invalid for every unit, or Cancelled (base/stop_scope.h).
  std::vector<RowOutcome> update(const Table& rows);
  /// The same of readings that are valid (Tracker::problem).
  std::vector<RowOutcome> update(std::vector<Reading> readings);

  const std::string& unit() const { return unit_; }
  bool is_new() const { return fresh_; }
  const Tracker& tracker() const { return *tracker_; }
  Forecast forecast() const { return state_->forecast(); }
  /// As TrackedUnit::in_populations, with its readings.
  std::optional<InPopulations> in_populations() const;
  const ChangeWatch& watch() const { return watch_; }
  /// The forecast in the units of the study, with the names of the monitor's /api/v1/units. Numbers
  /// that are not finite are null.
  nlohmann::ordered_json json() const;
  /// The probability that the threshold is reached within a use from now on, "500 h"; NaN if
  /// nothing determines it. Throws InputError that begins with "within".
  double risk(const std::string& within) const;
  /// How the unit is expected to continue, in the units of the study: at positions that show it
  /// (places_ahead). Rows of axis, level05, level50, level95.
  std::vector<ForecastBand> path() const;

 private:
  /// What it was before some rows.
  struct Before {
    std::string state, watch;  // saved
    std::size_t readings = 0, repeated = 0, contradicting = 0, refused = 0;
    std::string last_problem = {};
  };
  Before present() const;
  void go_back(const Before& before);
  std::vector<RowOutcome> taken(std::vector<Reading>& readings);

  std::shared_ptr<const Tracker> tracker_;
  std::string unit_;
  bool fresh_ = false;
  TrackerUnits reported_;
  std::unique_ptr<TrackedUnit> state_;
  ChangeWatch watch_ = {};
  std::vector<Reading> history_ = {};
  std::set<std::pair<std::vector<double>, std::vector<std::string>>> known_ = {};
  std::size_t repeated_ = 0, contradicting_ = 0, refused_ = 0;
  std::string last_problem_ = {};
};

/// The outcomes as JSON: an array of {counted, repeated, contradicts, p_value, problem}.
nlohmann::ordered_json outcomes_json(const std::vector<RowOutcome>& outcomes);

}  // namespace wearwell::prognosis
