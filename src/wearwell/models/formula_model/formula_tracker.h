#pragma once

#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::formula_model {

/// Tracks units of a formula model (docs/explanation/tracking.md). Null if the study measures lives
/// instead of a path along an axis. Throws InputError if it has no threshold, or its units cannot be
/// tracked.
std::unique_ptr<const prognosis::Tracker> track_units(const prognosis::CarriedState& state);

}  // namespace wearwell::formula_model
