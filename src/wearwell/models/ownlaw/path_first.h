#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::ownlaw {

/// Wear in proportion to force (or pressure) and distance, Archard's law; nothing where the table has no force.
std::optional<FirstStudy> first_wear_study(ColumnRoles& roles);

/// What is measured, as a straight line along cycles, time or distance, of units whose rates differ; nothing
/// where nothing is measured along anything.
std::optional<FirstStudy> first_degradation_study(ColumnRoles& roles);

}  // namespace wearwell::ownlaw
