#pragma once

#include <string>

#include "wearwell/models/clutch/clutch_study.h"

namespace wearwell::clutch {

/// What `wearwell fit` would do, ending with a newline: laws, data, unknowns with their units, what
/// is predicted.
std::string study_description(const ClutchStudy& study);

}  // namespace wearwell::clutch
