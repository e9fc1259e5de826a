#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::ownlaw {

/// A Weibull study of lives, or of intervals in which they ended; nothing where the table has none.
std::optional<FirstStudy> first_life_study(ColumnRoles& roles);

/// The same of lives under conditions that differ: Arrhenius' law of temperature, powers of all others.
std::optional<FirstStudy> first_accelerated_study(ColumnRoles& roles);

}  // namespace wearwell::ownlaw
