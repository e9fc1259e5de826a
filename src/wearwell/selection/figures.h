#pragma once

#include <vector>

#include "wearwell/present/html.h"
#include "wearwell/selection/result.h"

namespace wearwell {

/// R2 and R2p against the number of terms: of all models if the search evaluated all, else of the
/// best of each size.
std::vector<html::Figure> size_figures(const SelectionResult& result);

/// Observed against predicted, residuals, leverages of the best model.
std::vector<html::Figure> selection_fit_figures(const SelectionResult& result);

/// The frequency of each term in the models found.
std::vector<html::Figure> support_figures(const SelectionResult& result);

}  // namespace wearwell
