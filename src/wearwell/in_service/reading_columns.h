#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/named_columns.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::in_service {

/// The columns of a table of readings, one row for each reading of a unit.
struct ReadingColumns {
  std::string unit;
  /// As Tracker::columns; without a name where the table lacks one that need not be given.
  std::vector<fleet::UnitColumn> numbers;
  std::vector<std::string> labels;  ///< as Tracker::labels
  char text_decimal = 0;            ///< EngineColumn::text_decimal
};

/// Whether a table holds readings: by its headings or the options (--columns) it has the measured
/// quantity that the threshold is of.
bool has_readings(const std::vector<std::string>& options,
                  const std::vector<fleet::EngineColumn>& known, const prognosis::Tracker& tracker);

/// From the options and the table's own names: unit, and the study's columns and labels. Throws
/// InputError.
ReadingColumns read_reading_columns(const std::vector<std::string>& options,
                                    const std::vector<fleet::EngineColumn>& known,
                                    const prognosis::Tracker& tracker, const std::string& source);

}  // namespace wearwell::in_service
