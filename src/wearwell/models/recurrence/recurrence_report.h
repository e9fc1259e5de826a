#pragma once

#include <map>
#include <string>
#include <vector>

#include "wearwell/models/recurrence/forecast.h"
#include "wearwell/models/recurrence/process.h"
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
  std::vector<Quantity> ahead;  ///< of forecasts; empty: none
};

/// Bounds of the mean cumulative function and ends of intervals hold 90 %.
inline constexpr double report_level = 0.9;

/// The mean cumulative function, tests, forecasts: tables, terminal text, `repairable` in summary.json.
PresetAddition recurrence_addition(const Asked& asked, const WeightedDraws& draws);

/// The mean cumulative function with its band, and the fitted one.
std::map<std::string, std::vector<html::Figure>> recurrence_figures(const Asked& asked,
                                                                    const WeightedDraws& draws);

/// "between 100 and 200 h", the ages at which no unit was observed; empty if there are none.
std::string unobserved_text(const Asked& asked);

/// "100 h", as the study states it.
std::string given_quantity(const Quantity& quantity);

/// An age for people, in the unit of the data: "3 256.3", at most six digits.
std::string age_number(double in_unit);

}  // namespace wearwell::recurrence
