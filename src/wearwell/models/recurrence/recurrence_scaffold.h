#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::recurrence {

/// A study of the failures of repaired units: rows of a unit are its failures at rising ages, and at
/// most the last one is the end of its observation. Empty if the table is none.
std::optional<Scaffold> scaffold(ColumnRoles& roles);

}  // namespace wearwell::recurrence
