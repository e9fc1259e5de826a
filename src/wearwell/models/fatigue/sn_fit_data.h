#pragma once

#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell {

/// The hypotheses of the check `fit` for an S-N study. Residuals may depend on the stress, at the
/// start values of searches, and on the mean stress.
FitData sn_fit_data(const fatigue::SnLaw& law, const SnData& data,
                    const std::vector<Parameter>& parameters);

}  // namespace wearwell
