#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/prognosis/tracker.h"

namespace wearwell::prognosis {

/// Running units in their present state: of a result, or of a monitored fleet.
struct FollowedUnits {
  const Tracker* tracker = nullptr;
  std::vector<std::string> names;
  std::string source = "study";  ///< noun for what holds them: "fleet"
  std::function<std::unique_ptr<TrackedUnit>(const std::string& name)> unit;
  std::function<History(const std::string& name)> history;  ///< all its readings since the study
};

/// The units of a study, with its readings of them alone. Refers to the tracker.
FollowedUnits units_of_study(const Tracker& tracker);

/// Throws InputError that begins with "--unit" unless there is such a unit.
void require_known(const FollowedUnits& units, const std::string& name);

/// The place of the observed quantity among the tracker's columns; empty if readings observe none.
std::optional<std::size_t> measured_column(const Tracker& tracker);

/// What is known of a reading before it is taken: the position on the axis and the conditions,
/// `given` as "force = 20 N". Throws InputError that begins with "--given".
Reading next_reading(const Tracker& tracker, double position,
                     const std::vector<std::string>& given);

}  // namespace wearwell::prognosis
