#pragma once

#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::formula_model {

/// Follows units of a law in the user's own words (docs/explanation/tracking.md). Throws InputError where the study asks for
/// no limit, or its units cannot be followed.
std::unique_ptr<const prognosis::Tracker> track_units(const prognosis::CarriedState& state);

}  // namespace wearwell::formula_model
