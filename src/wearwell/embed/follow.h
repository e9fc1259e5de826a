#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/embed/fitted.h"
#include "wearwell/prognosis/unit_tracker.h"

namespace wearwell::embed {

/// The units of a fit that can be followed by their readings. Shared by threads.
struct Population {
  std::shared_ptr<const prognosis::Tracker> tracker;
  Source source;  ///< the study with its data
  bool trusted = true;
};

/// Throws InputError where single units of the model cannot be followed.
std::shared_ptr<const Population> population_of(const Fitted& fitted);

/// One unit on line. Columns of rows are those of the study's data or its names; without a unit
/// they are in the study's. One thread at a time.
class FollowedUnit {
 public:
  /// An empty `unit` is the only one of the study, or, if `fresh`, one called "new". Throws
  /// InputError that begins with "unit".
  FollowedUnit(std::shared_ptr<const Population> population, const std::string& unit, bool fresh);

  /// The outcome of each row, as prognosis::outcomes_json. Throws InputError that names row and
  /// column; then no row is taken.
  std::string update(const Table& rows);
  /// As prognosis::UnitTracker.
  std::string json() const;
  double risk(const std::string& within) const;
  std::vector<prognosis::ForecastBand> path() const;

 private:
  std::shared_ptr<const Population> population_;
  prognosis::UnitTracker tracker_;
};

/// As `wearwell backtest`.
struct Backtested {
  std::string text, json;
  std::string forecasts;  ///< CSV
};
Backtested backtest(const Population& population, const Table& readings, const Table& lives);

}  // namespace wearwell::embed
