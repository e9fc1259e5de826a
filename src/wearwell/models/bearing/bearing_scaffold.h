#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::bearing {

/// A study of wear depths of journal bearings, or nothing where the headings name none.
std::optional<Scaffold> scaffold(ColumnRoles& roles);

}  // namespace wearwell::bearing
