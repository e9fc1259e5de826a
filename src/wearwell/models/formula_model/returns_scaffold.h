#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// A Weibull study of a returns triangle (returns_triangle.h); empty for any other table.
std::optional<Scaffold> first_returns_study(ColumnRoles& roles);

}  // namespace wearwell::formula_model
