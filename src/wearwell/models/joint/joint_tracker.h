#pragma once

#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::joint {

/// Tracks the one joint of a study, under its name in the study (data.joint): inspections update
/// the posterior of its k, sigma, V0 and exponent, and where the nodes no longer resolve it, it is
/// integrated again over all inspections. Units of any other name are refused: the study has no
/// variation between joints. Throws InputError if the study has no predict.limit, or its volumes
/// come from pin positions, many rows per inspection.
std::unique_ptr<const prognosis::Tracker> track_joint(const prognosis::CarriedState& state);

}  // namespace wearwell::joint
