#pragma once

#include <memory>
#include <optional>

#include "wearwell/base/rng.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/infer/fit_check.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// The scores for the check of fit of a formula model (docs/reference/checks.md), by measured
/// column; none if readings of a process are truncated. Random effects are drawn given x and the
/// unit's rows: both together are a draw from the posterior, under which residuals and effects are
/// standard normal. A reading of a process is scored given the earlier ones.
std::optional<FitData> fit_data(std::shared_ptr<const FormulaRows> rows);

/// The normal score of an observation, for a count those of its ends (bayes/normal_score.h).
/// `family_parameters` are those of the form's family, SI.
NormalScore score_of(const ResponseForm& form, const Response& y, const double* family_parameters);
/// The same of a life that may be a mixture, whose parameters these are.
NormalScore score_of(const ResponseForm& form, const LifeMixture& life, const Response& y,
                     const double* family_parameters);

/// Random numbers that are the same for the same parameters, for every caller.
Rng lots_at(const double* x, std::size_t count);

}  // namespace wearwell::formula_model
