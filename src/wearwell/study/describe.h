#pragma once

#include <string>

#include "wearwell/study/posterior_study.h"

namespace wearwell {

/// "normal, mean 0.000505, sd 7.4e-05, above 0 mm^3/(N m)".
std::string prior_text(const Parameter& parameter);

/// Describes what `wearwell fit` would do: equation, data, unknowns with their units and priors,
/// predictions, sampler. Ends with a newline.
std::string study_description(const PosteriorStudy& study);

}  // namespace wearwell
