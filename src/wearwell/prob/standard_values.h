#pragma once

#include "wearwell/prob/standard_law.h"

namespace wearwell {

/// What standard_law.h gives, to the same bits, without the slopes: of the normal law these cost as much again.
double log_cdf_value(StandardLaw law, double z);
double log_survival_value(StandardLaw law, double z);

}  // namespace wearwell
