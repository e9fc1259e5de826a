#pragma once

#include "wearwell/models/formula_model/returns_triangle.h"

namespace wearwell::formula_model {

/// Counts a table of single units as a triangle. `keys` names its columns: `sold`, the month or day of sale; `returned`, that
/// of the return, empty for a unit that did not come back; `quantity`, if a row stands for several units; and `mode`, the failure mode. `until` is the
/// last period that the table covers: later returns and sales are left out, with a note. Throws InputError that names the
/// cell: an unreadable period, a return before the sale, a failure mode without one. `words` are those of [failure_modes].
ReturnsTriangle counted_triangle(const TomlReader& keys, const Table& units,
                                 const ModeWords& words = {});

}  // namespace wearwell::formula_model
