#pragma once

#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::bearing {

/// Tracks single bearings: each has its own k if the study has k_scatter, else all share one. The
/// readings and the life of a bearing depend only on its ln k and on sigma, which are the two
/// values of a node. Throws InputError if the study has no predict.limit, or no column that orders
/// the inspections.
std::unique_ptr<const prognosis::Tracker> track_bearings(const prognosis::CarriedState& state);

}  // namespace wearwell::bearing
