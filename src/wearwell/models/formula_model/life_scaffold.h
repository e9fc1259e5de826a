#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// A Weibull study of lives, or of intervals in which they ended; nothing where the table has none.
std::optional<Scaffold> first_life_study(ColumnRoles& roles);

/// The same of lives under conditions that differ: Arrhenius' law of temperature, powers of all others.
std::optional<Scaffold> first_accelerated_study(ColumnRoles& roles);

}  // namespace wearwell::formula_model
