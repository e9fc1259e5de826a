#pragma once

#include <string>
#include <vector>

#include "wearwell/in_service/unit_rows.h"
#include "wearwell/study/result.h"

namespace wearwell::in_service {

/// The parts of the report on a fleet of units in service.
struct LivesFindings {
  std::string title, fingerprint, engine, layout;
  std::string noun = "unit";  ///< of the lives: "machine"
  std::vector<std::string> files;
  Unit axis;                     ///< of lives, as shown
  std::vector<double> horizons;  ///< SI, ascending
  UnitColumns columns;
  UnitRows rows;
  prognosis::FleetOutlook outlook;
  bool trusted_fit = true;
  double longest_seen = 0;  ///< conditions.h
  std::size_t points = 0;   ///< of the posterior that represent the population
};

/// units.parquet has every unit, first those that have the shortest B10 of remaining life.
/// `skip_bad`: rows may have been left out, so the check `left-out` says how many.
Result lives_fleet_result(const LivesFindings& found, bool skip_bad);

}  // namespace wearwell::in_service
