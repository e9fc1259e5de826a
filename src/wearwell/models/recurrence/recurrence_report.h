#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/models/recurrence/forecast.h"
#include "wearwell/models/recurrence/growth_test.h"
#include "wearwell/models/recurrence/process.h"
#include "wearwell/study/classical_table.h"
#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::recurrence {

/// Whose failures are counted ahead.
struct ForecastRow {
  std::string of, from;  ///< "all 41 units", "from their ages now"
  std::vector<UnitState> units;
};

/// What a study of repairable units reports.
struct Asked {
  Process process;
  RecurrenceData data;
  std::vector<ForecastRow> rows;
  std::vector<Quantity> ahead;            ///< of forecasts; empty: none
  std::vector<double> ages;               ///< at which one unit is asked about [SI]
  std::optional<LifeLevels> levels = {};  ///< predict.level and sides; empty: intervals hold 90 %
  std::optional<ClassicalLevel> classical = {};
  std::optional<GrowthTest> growth_test = {};  ///< with delayed fixes to project
  std::vector<Parameter> parameters = {};
  DensityUnit density = {};

  /// The probability beyond each end of the intervals.
  double outside() const { return levels ? levels->below() : 0.05; }
  /// "90 %", or "95 % one-sided" of each end.
  std::string interval_name() const;
};

/// The mean cumulative function, tests, forecasts: tables, terminal text, `repairable` in summary.json.
PresetAddition recurrence_addition(const Asked& asked, const Fit& fit);

/// The mean cumulative function with its band, and the fitted one.
std::map<std::string, std::vector<html::Figure>> recurrence_figures(const Asked& asked,
                                                                    const WeightedDraws& draws);

/// "between 100 and 200 h", the ages at which no unit was observed; empty if there are none.
std::string unobserved_text(const Asked& asked);

/// "100 h", as the study states it.
std::string given_quantity(const Quantity& quantity);

/// An age for people, in the unit of the data: "3 256.3", at most six digits.
std::string age_number(double in_unit);
/// "3 256.3 h", of an age in SI.
std::string age_text(const RecurrenceData& data, double si);

}  // namespace wearwell::recurrence
