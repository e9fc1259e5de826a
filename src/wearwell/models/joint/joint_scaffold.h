#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::joint {

/// A study of worn volumes against cycles; empty if the headings have none.
std::optional<Scaffold> scaffold(ColumnRoles& roles);

}  // namespace wearwell::joint
