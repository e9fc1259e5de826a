#pragma once

#include "wearwell/study/column_roles.h"

namespace wearwell::formula_model {

/// The column of the specimens of a step-stress test (step_stress.h): each row is a step with the age at its end. Ages of a specimen
/// rise, at most its last row is a failure, and `stress`, one of a few levels, changes between its rows. Null for other tables, and if
/// a column holds readings.
const Column* specimens_of_steps(const ColumnRoles& roles, ColumnRoles::Roles stresses);

}  // namespace wearwell::formula_model
