#pragma once

#include <optional>

#include "wearwell/study/column_roles.h"

namespace wearwell::fatigue {

/// A study of lives under stresses; empty if the headings have none.
std::optional<Scaffold> scaffold(ColumnRoles& roles);

/// A study of lives under strains.
std::optional<Scaffold> first_strain_study(ColumnRoles& roles);

/// A study of stresses and outcomes without lives: an up-and-down sequence.
std::optional<Scaffold> first_staircase(ColumnRoles& roles);

}  // namespace wearwell::fatigue
