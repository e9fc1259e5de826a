#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/prob/family_form.h"
#include "wearwell/prob/plotting_positions.h"
#include "wearwell/prob/response.h"

namespace wearwell::workbench {

/// A family fitted to lives under one condition by maximum likelihood.
struct FittedFamily {
  const ResponseForm* form = nullptr;
  std::vector<double> parameters;  ///< in the form's order, SI
  double log_likelihood = 0;       ///< of lives in SI
  double aic() const { return 2 * (static_cast<double>(parameters.size()) - log_likelihood); }
};

/// None if the likelihood has no maximum. Lives are positive.
std::optional<FittedFamily> fitted_family(const ResponseForm& form,
                                          std::span<const Response> responses,
                                          std::span<const int> counts);

/// The form of a positive family by its name, without a threshold.
const ResponseForm& form_named(std::string_view name);

/// The plotting positions on the paper of the family, (life, quantile of its share), at most `most`, evenly
/// chosen.
std::vector<PlottingPosition> on_paper(const Paper& paper, std::vector<PlottingPosition> positions,
                                       std::size_t most);

/// The fitted distribution on its paper, from the share `low` to `high`.
std::vector<PlottingPosition> line_on_paper(const FittedFamily& fitted, double low, double high);

}  // namespace wearwell::workbench
