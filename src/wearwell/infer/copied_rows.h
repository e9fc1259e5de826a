#pragma once

#include <optional>
#include <vector>

#include "wearwell/infer/fit_check.h"

namespace wearwell {

/// Observations that repeat an earlier one in every number and label, against how many do so by chance where
/// numbers are rounded. Rounding is read off the repeated values themselves: the step of which four fifths of them are
/// multiples, or as many significant digits as four fifths of them have, whichever is coarser. Two observations under
/// the same conditions agree with the probability density times step; pairs are counted as Poisson's. Values that
/// are 0 or known to lie in an interval repeat nothing.
/// `log_density` of each observation, SI. None where fewer than three distinct values are repeated.
std::optional<CopiedRows> copied_rows(const FitData& data, const std::vector<double>& log_density);

}  // namespace wearwell
