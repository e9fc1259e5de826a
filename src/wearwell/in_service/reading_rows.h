#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <unordered_set>
#include <vector>

#include "wearwell/fleet/engine.h"
#include "wearwell/in_service/reading_columns.h"
#include "wearwell/in_service/rows_read.h"
#include "wearwell/in_service/study_readings.h"

namespace wearwell::in_service {

/// The readings of one unit that are new to the study, along the axis of life.
struct UnitReadings {
  std::string unit;
  bool of_study = false;  ///< the study has the unit, with readings of its own
  std::vector<prognosis::Reading> readings = {};
};

/// Rows of a table of readings.
struct ReadingRows : RowsRead {
  double in_study = 0;                    ///< rows that are rows of the study
  std::unordered_set<std::string> units;  ///< all that were taken
};

struct ReadReadings {
  bool skip_bad = false;  ///< leave out rows that cannot be used
  std::stop_token stop = {};
};

/// Gives the units of an engine's table one after the other, each with all its readings, in one pass
/// over the table. Throws InputError for rows that cannot be used (without `skip_bad`), and for a
/// unit that an earlier table has; Cancelled.
void for_each_unit(fleet::Engine& engine, const ReadingColumns& columns,
                   const prognosis::Tracker& tracker, const StudyReadings& study,
                   const ReadReadings& how, ReadingRows& rows,
                   const std::function<void(UnitReadings&& unit)>& take);

}  // namespace wearwell::in_service
