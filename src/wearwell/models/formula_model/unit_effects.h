#pragma once

#include <optional>
#include <vector>

#include "wearwell/models/formula_model/written_study.h"

namespace wearwell::formula_model {

/// Random effects by how they are treated.
struct ChosenEffects {
  std::optional<WrittenEffects> units;  ///< of the units, which are integrated out
  std::vector<WrittenEffects> drawn;    ///< drawn with the parameters (formula_drawn.h)
};

/// Which effects identify units and are integrated out: of more than two, the first `integrated`. Throws InputError.
ChosenEffects choose_effects(const TomlReader& root, const WrittenStudy& study,
                             std::size_t integrated, const FormulaData& data);

/// Adds the effects that are integrated out, and the symbols of rows. Throws InputError.
void add_unit_effects(const TomlReader& root, const ChosenEffects& chosen, FormulaModel& model);

/// Compiles their scatters and correlation.
void compile_population(const TomlReader& root, const ChosenEffects& chosen, FormulaModel& model);

}  // namespace wearwell::formula_model
