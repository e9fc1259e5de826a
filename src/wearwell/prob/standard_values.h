#pragma once

#include "wearwell/prob/standard_distribution.h"

namespace wearwell {

/// The values of standard_distribution.h, identical but without slopes, which double the cost for the normal
/// distribution.
double log_cdf_value(StandardDistribution distribution, double z);
double log_survival_value(StandardDistribution distribution, double z);

}  // namespace wearwell
