#pragma once

#include "wearwell/input/table.h"

namespace wearwell::prognosis {

/// A monitor's export marks the readings of units in doubt in a column `doubt`. Throws InputError if rows
/// of `fresh` have 1 there, unless the study's table has such a column itself.
void refuse_doubted_rows(const Table& fresh, const Table& of_study);

}  // namespace wearwell::prognosis
