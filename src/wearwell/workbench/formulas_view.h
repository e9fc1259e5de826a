#pragma once

#include <nlohmann/json.hpp>

namespace wearwell::workbench {

/// The formulas among the keys of a study (study_form.h), typeset: each line of [formula], and each likelihood as "y ~ normal(mean = ...)".
/// [{path, line, math}]; `math` is an element [tag, text, [elements]] of MathML, or null where the
/// expression has an error.
nlohmann::ordered_json formulas_json(const nlohmann::ordered_json& keys);

}  // namespace wearwell::workbench
