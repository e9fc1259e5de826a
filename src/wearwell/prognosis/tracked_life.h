#pragma once

#include <optional>
#include <string>

#include "wearwell/prognosis/tracker.h"
#include "wearwell/prognosis/unit_life.h"

namespace wearwell::prognosis {

/// The name among those that the tracker knows, or refuses, which a question means: "J7", or "part
/// J7". Empty if it means none.
std::optional<std::string> tracked_name(const Tracker& tracker, const std::string& asked);

/// The remaining useful life of a tracked unit whose only new reading is `LifeQuestion::survived`:
/// for studies whose only reading is that. Throws InputError if the tracker refuses the unit or the
/// value.
UnitLife tracked_life(const Tracker& tracker, const std::string& name,
                      const LifeQuestion& question);
/// The same of a unit that has taken readings; `LifeQuestion::survived` is one more of it.
UnitLife tracked_life(const Tracker& tracker, const std::string& name, const LifeQuestion& question,
                      TrackedUnit& unit);

}  // namespace wearwell::prognosis
