#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/plan/answer.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/prognosis/next_reading.h"

namespace wearwell::plan {

/// When to inspect, as a user asks. Use is "500 h", in a unit of the lives' axis; a probability
/// "1 %" or 0.01; an amount "60 EUR". Empty texts are not asked for.
struct InspectQuestion {
  std::string risk = {};  ///< at most, of each interval; "1 %" if neither it, `total_risk` nor
                          ///< costs are given
  std::string total_risk =
      {};                    ///< at most, of a failure that no inspection foresees, for each unit
  std::string warning = {};  ///< an inspection shows a failure that comes within this use after it
  std::string until = {};    ///< default: the time by which half of the units reach their threshold
  std::string step = {};     ///< inspections at multiples of it
  std::string unit = {};     ///< one running unit
  bool fresh = false;        ///< a new unit; also if there is no running one
  std::string inspection_cost = {}, failure_cost = {}, replacement_cost = {};
  std::string downtime_cost = {};  ///< of an undetected failure, "5 EUR/h": failures are hidden
  std::string visit_cost = {};     ///< of a visit, whatever the number of units inspected
  std::vector<std::string> given = {};  ///< conditions of the next reading: "force = 20 N"
};

/// Inspection times of one unit, or of all running units; the cheapest ones with costs, else the
/// fewest. `followed`: the units that `lives` are of, in their present state; its tracker is null if
/// they cannot be followed. Throws InputError that begins with the option's name; Cancelled.
Answer inspect(const InspectQuestion& question, const prognosis::KnownLives& lives,
               const prognosis::FollowedUnits& followed, const Monitor& monitor = {});

}  // namespace wearwell::plan
