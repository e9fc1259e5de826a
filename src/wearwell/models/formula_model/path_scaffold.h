#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// Wear proportional to force (or pressure) and distance, Archard's law; empty if the table has no
/// force.
std::optional<Scaffold> wear_scaffold(ColumnRoles& roles);

/// The measured quantity as a straight line along cycles, time or distance, for units whose rates
/// vary; empty if there is no measured quantity or no axis.
std::optional<Scaffold> first_degradation_study(ColumnRoles& roles);

}  // namespace wearwell::formula_model
