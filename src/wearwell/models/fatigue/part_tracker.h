#pragma once

#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::fatigue {

/// Follows parts that run under one stress each and have not broken: a run-out of the study (data.columns.unit names it), whose cycles the posterior
/// has already and which count once, or a new one. A reading is the cycles survived, and the stress where it is not the same for all; what moves
/// is which of the posterior's points a part goes with that came so far, so no order of readings matters. What is
/// limited is the share of its life that a part has used, n/N, which is 1 where it breaks. Life may have no end (fatigue limits): the lives
/// then are infinite with that probability. Throws InputError.
std::unique_ptr<const prognosis::Tracker> track_parts(const prognosis::CarriedState& state);

}  // namespace wearwell::fatigue
