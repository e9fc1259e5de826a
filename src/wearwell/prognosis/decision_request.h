#pragma once

#include <string>
#include <vector>

#include "wearwell/prognosis/decisions_report.h"
#include "wearwell/prognosis/next_reading.h"

namespace wearwell::prognosis {

/// What to decide, as texts of options; an empty one is not given.
struct DecisionRequest {
  std::string failure_cost, replacement_cost;  ///< "12000 EUR"
  std::string inspection_cost = {};
  std::string downtime_cost = {};  ///< of failures that only an inspection shows, "5 EUR/h"
  std::string month = {};          ///< use of a unit per month, "600 h"
  std::string claims = {};         ///< share of units that may fail under warranty, "2 %"
  /// The value of another reading of one unit: both or none. Conditions as "force = 20 N".
  std::string unit = {}, inspect_after = {};
  std::vector<std::string> given = {};
  int months = 12;
  double service = 0.95;  ///< probability that the spare parts suffice
};

/// Decisions on `lives`; `units` are those that are followed by readings, if any. Throws InputError
/// that begins with the option's name.
DecisionsReport decide(const DecisionRequest& request, KnownLives lives,
                       const FollowedUnits& units);

}  // namespace wearwell::prognosis
