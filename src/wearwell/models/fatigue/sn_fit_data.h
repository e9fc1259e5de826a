#pragma once

#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell {

/// What the check `fit` asks of an S-N study. Residuals may follow the stress that the law takes for the cause, at the values where
/// searches start, and the mean stress.
FitData sn_fit_data(const fatigue::SnLaw& law, const SnData& data,
                    const std::vector<Parameter>& parameters);

}  // namespace wearwell
