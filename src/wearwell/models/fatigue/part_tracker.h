#pragma once

#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::fatigue {

/// Tracks parts that have not failed: a run-out of the study (named by data.columns.part), whose
/// cycles are already in the posterior and count once, or a new one. A reading is the survived
/// cycles, and the stress since the reading before it along the life, unless it is the same for all.
/// It reweights the posterior's points by the survival of the part, so the order of readings does not
/// matter; under several stresses this is the survival of Miner's sum (part_damage.h). The part
/// continues under its last stress. The quantity with the threshold is the used share of its life,
/// which is 1 at failure: n/N, or the damage. Life may have no end (fatigue limits): lives are then
/// infinite with that probability. Throws InputError.
std::unique_ptr<const prognosis::Tracker> track_parts(const prognosis::CarriedState& state);

}  // namespace wearwell::fatigue
