#pragma once

#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::bearing {

/// Follows single bearings on line: each has its own k where the study has k_scatter, else all share one. Of a
/// bearing's readings and its life only ln k of its own and sigma matter, so these two are what a node has. Throws
/// InputError where the study has no predict.limit, or no column along which bearings are inspected.
std::unique_ptr<const prognosis::Tracker> track_bearings(const prognosis::CarriedState& state);

}  // namespace wearwell::bearing
