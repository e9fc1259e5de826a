#pragma once

#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/fleet/engine.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/study/model.h"
#include "wearwell/study/result.h"

namespace wearwell::in_service {

/// What is asked of a fleet of units in service.
struct LivesRequest {
  std::vector<std::string> columns = {};   ///< in the form of read_unit_columns
  std::vector<std::string> files = {};     ///< for the report; default: the engines' sources
  std::string point = {};                  ///< which life of [predict]; empty: the study's headline
  std::vector<std::string> horizons = {};  ///< "500 h"; empty: fractions of the median life
  bool in_study = false;                   ///< the study has all units as run-outs of their ages
  bool skip_bad = false;                   ///< leave out rows that cannot be used, and report them
};

/// The failures to come of units in service, by a fitted life distribution, or by the life to the
/// failure threshold of a degradation model: each unit has survived to its age. Of a table of readings
/// `fleet_of_readings`. `result` is the name of the fit. Throws InputError that names table, column, unit and value; Cancelled.
Result fleet_of_lives(const prognosis::CarriedState& state, const std::string& result,
                      Models models, const std::vector<fleet::Engine*>& engines,
                      const LivesRequest& request, const Monitor& monitor);

}  // namespace wearwell::in_service
