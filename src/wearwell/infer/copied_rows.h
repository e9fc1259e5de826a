#pragma once

#include <optional>
#include <vector>

#include "wearwell/infer/fit_check.h"

namespace wearwell {

/// Compares the number of observations that repeat an earlier one in every number and label with
/// the number expected by chance for rounded numbers. The rounding is estimated from the repeated
/// values: the step of which four fifths of them are multiples, or the significant digits that four
/// fifths of them have, whichever is coarser. Two observations under the same conditions agree with
/// probability density times step; the number of pairs is Poisson. Zeros and interval-censored
/// values are ignored. `log_density` of each observation, SI. Empty if fewer than three distinct
/// values are repeated.
std::optional<CopiedRows> copied_rows(const FitData& data, const std::vector<double>& log_density);

}  // namespace wearwell
