#pragma once

#include "wearwell/prob/standard_distribution.h"

namespace wearwell {

/// What standard_distribution.h gives, to the same bits, without the slopes: of the normal law these cost as much again.
double log_cdf_value(StandardDistribution distribution, double z);
double log_survival_value(StandardDistribution distribution, double z);

}  // namespace wearwell
