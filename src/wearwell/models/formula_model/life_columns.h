#pragma once

#include <string>

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// Whether a table has a column of failure modes: they differ from row to row; one word in all rows says nothing.
bool has_modes(const ColumnRoles& roles);

/// Without a column that states how lives ended the words of the mode column do: a line of [failure_modes], or none. A long word for
/// a run-out is known; a short one can be a mode, which the user states; and asks what an empty cell means.
std::string runouts_of_modes(ColumnRoles& roles, const Column& column);

/// The number of parts of a row: a line of [data.columns], or none.
std::string take_count(ColumnRoles& roles);

}  // namespace wearwell::formula_model
