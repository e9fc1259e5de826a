#pragma once

#include <optional>
#include <vector>

#include "wearwell/models/formula_model/formula_conditions.h"
#include "wearwell/models/formula_model/formula_likelihood.h"

namespace wearwell::formula_model {

/// A specimen of a step-stress or ramp test whose last stress stands for all: the one in the middle of the failures by
/// their last stress.
struct ExposureReference {
  std::size_t specimen = 0;  ///< among the observations
  Conditions conditions;     ///< its last ones
};

/// Empty without failures, or if the life is one of several or of units that vary.
std::optional<ExposureReference> exposure_reference(const FormulaModel& model);

/// The specimens as lives under the constant conditions of the reference, by cumulative exposure at the parameters x:
/// the age at which the same share would have failed there. Empty if another parameter than the scale differs between
/// specimens, as no age is equivalent then.
std::vector<Response> exposure_lives(const FormulaRows& rows, const ExposureReference& reference,
                                     const double* x);

}  // namespace wearwell::formula_model
