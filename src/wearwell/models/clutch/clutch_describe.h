#pragma once

#include <string>

#include "wearwell/models/clutch/clutch_study.h"

namespace wearwell::clutch {

/// Description of what `wearwell fit` does, ending with a newline: formulas, data, unknowns with
/// their units, predictions.
std::string study_description(const ClutchStudy& study);

}  // namespace wearwell::clutch
