#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::joint {

/// A study of worn volumes against cycles, or nothing where the headings name none.
std::optional<Scaffold> scaffold(ColumnRoles& roles);

}  // namespace wearwell::joint
