#pragma once

#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/in_service/rows_read.h"
#include "wearwell/prognosis/failure_totals.h"
#include "wearwell/prognosis/population_weights.h"
#include "wearwell/prognosis/tracker_units.h"
#include "wearwell/study/result.h"

namespace wearwell::in_service {

/// A unit that is followed by its readings, in the units of the study.
struct FollowedUnit {
  std::string name;
  bool of_study = false;
  bool known = true;    ///< false: nothing determines how it goes on; then it has no numbers
  bool beyond = false;  ///< its last reading measures a level beyond the threshold
  std::size_t readings = 0, contradicting = 0, refused = 0;  ///< since the study
  double at = 0;                                             ///< its farthest reading
  prognosis::Interval level, remaining;
  double b10 = 0, passed = 0;
  std::vector<double> failing;  ///< by horizon; what has passed the threshold already included
  std::string doubt, problem;   ///< why its forecast is in doubt; of the last refused reading
};

/// The parts of the report on units that are followed by readings.
struct ReadingsFindings {
  std::string title, fingerprint, engine, layout;
  std::string noun = "unit", axis_name, limited;
  std::vector<std::string> files;
  Unit axis, level;              ///< as shown
  double limit = 0;              ///< the threshold, as shown
  std::vector<double> horizons;  ///< SI, ascending
  RowsRead rows;
  double in_study = 0;  ///< rows of the study
  std::vector<FollowedUnit> units;
  std::vector<prognosis::FleetFailures> failures;  ///< by horizon
  std::size_t points = 0;                          ///< of the population
  /// Given the readings of all units; empty: they count as independent, `why` has the reason.
  prognosis::PopulationWeights population;
  std::string why;
  bool trusted_fit = true;
  double longest_seen = 0;  ///< conditions.h
};

/// units.parquet has every unit, first those that most likely fail within the first horizon.
Result readings_fleet_result(const ReadingsFindings& found, bool skip_bad);

}  // namespace wearwell::in_service
