#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// A measured response (a wear rate, a coefficient of friction) under the conditions of its row;
/// empty if no column is a response, or the table has no conditions.
std::optional<Scaffold> response_scaffold(ColumnRoles& roles);

}  // namespace wearwell::formula_model
