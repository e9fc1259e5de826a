#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell {

/// A table of a response with inputs: the text is the options of `wearwell select`. Nothing where the table has none.
std::optional<Scaffold> first_selection(ColumnRoles& roles);

/// A word as a shell takes it.
std::string shell_word(const std::string& text);

}  // namespace wearwell
