#pragma once

#include <optional>

#include "wearwell/prob/family_form.h"

namespace wearwell {

/// The mean residual life E[T - from | T > from] of a positive family, from its closed form; from 0, the mean life.
/// Infinite where the integral is, unlike `center` (response.h), which then is the median; NaN where a parameter is
/// invalid. None without a closed form: then it is an integral (math/mean_beyond.h). Relative error 1e-10, beyond
/// `from` 1e-8.
///
/// From 0 it is known of all families; from later on of the Weibull, exponential,
/// gamma, lognormal and generalized gamma (not near the lognormal, where the integral keeps more digits).
std::optional<double> mean_residual_life(ResponseFamily family, double from,
                                         const double* family_parameters);

}  // namespace wearwell
