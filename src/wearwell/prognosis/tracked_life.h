#pragma once

#include <optional>
#include <string>

#include "wearwell/prognosis/tracker.h"
#include "wearwell/prognosis/unit_life.h"

namespace wearwell::prognosis {

/// The name among those that the tracker has seen, or that it refuses, which a question means: "J7", or "part J7". Nothing where it means none.
std::optional<std::string> tracked_name(const Tracker& tracker, const std::string& asked);

/// What remains to a unit on line that has shown nothing since the study but that it came to `LifeQuestion::survived`:
/// of studies whose only reading is that. Throws InputError where the tracker refuses the unit, or what it is said to have survived.
UnitLife tracked_life(const Tracker& tracker, const std::string& name,
                      const LifeQuestion& question);

}  // namespace wearwell::prognosis
