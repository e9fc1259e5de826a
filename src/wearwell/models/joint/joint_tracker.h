#pragma once

#include <memory>

#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::joint {

/// Follows the one joint that a study is of, under the name that the study gives it (data.joint): inspections move the posterior of its k, sigma, V0 and
/// exponent, and where the nodes resolve that no more it is integrated anew over all inspections. Units of any
/// other name are refused: nothing in the study says how joints differ. Throws InputError where the study has no
/// predict.limit, or its volumes are of pin positions, many rows an inspection.
std::unique_ptr<const prognosis::Tracker> track_joint(const prognosis::CarriedState& state);

}  // namespace wearwell::joint
