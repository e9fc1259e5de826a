#pragma once

#include <string>

#include "wearwell/selection/result.h"

namespace wearwell {

/// A selection as one self-contained page: verdict, all models by size, the fit, coefficients,
/// models near the best, method. There must be a model.
std::string selection_report(const SelectionResult& result);

}  // namespace wearwell
