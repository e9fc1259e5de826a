#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// Wear in proportion to force (or pressure) and distance, Archard's law; nothing where the table has no force.
std::optional<Scaffold> wear_scaffold(ColumnRoles& roles);

/// What is measured, as a straight line along cycles, time or distance, of units whose rates differ; nothing
/// where nothing is measured along anything.
std::optional<Scaffold> first_degradation_study(ColumnRoles& roles);

}  // namespace wearwell::formula_model
