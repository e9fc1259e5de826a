#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// A Weibull study of lives, or of intervals that contain them; empty if the table has none.
std::optional<Scaffold> first_life_study(ColumnRoles& roles);

/// The same for lives under several conditions: Arrhenius' law for temperature, power laws for the
/// others.
std::optional<Scaffold> first_accelerated_study(ColumnRoles& roles);

}  // namespace wearwell::formula_model
