#pragma once

#include <memory>
#include <optional>

#include "wearwell/infer/fit_check.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// The scores by which the check of fit judges a law (docs/reference/checks.md), measured column by column; none where readings of a
/// process are truncated. Where units differ their effects are drawn from what x and their rows say of them: a draw of both
/// together is one of the posterior, under which residuals and effects are standard normal. A reading of a
/// process is scored in the light of those before it.
std::optional<FitData> fit_data(std::shared_ptr<const FormulaRows> rows);

}  // namespace wearwell::formula_model
