#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::bearing {

/// A study of wear depths of journal bearings; empty if the headings have none.
std::optional<Scaffold> scaffold(ColumnRoles& roles);

}  // namespace wearwell::bearing
