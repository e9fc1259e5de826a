#pragma once

#include "wearwell/models/ownlaw/own_law.h"
#include "wearwell/study/density_unit.h"

namespace wearwell::ownlaw {

/// The units of the measured columns, factor by factor of the likelihood: units where these are its factors, else
/// observations, column by column.
DensityUnit density_unit(const OwnLaw& law);

}  // namespace wearwell::ownlaw
