#pragma once

#include <optional>

#include "wearwell/base/shell_word.h"
#include "wearwell/study/column_roles.h"

namespace wearwell {

/// For a table of a response with inputs: the options of `wearwell select`. Empty for other tables.
std::optional<Scaffold> first_selection(ColumnRoles& roles);

}  // namespace wearwell
