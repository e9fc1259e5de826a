#pragma once

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/ownlaw/own_law.h"

namespace wearwell::ownlaw {

/// Sorts the rows unit by unit, along the axis where they follow each other. Throws InputError where it is not
/// told which rows do, or along what.
void order_rows(OwnLaw& law, const TomlReader& root);

/// A process that only rises has readings that do, along a unit's rows. Throws InputError.
void require_rising(const OwnLaw& law);

/// Lives without one failure have no upper end but their prior's. Throws InputError.
void require_failures(const OwnLaw& law);

/// A study of lives names the column that says how each ended, where its table has one. Throws InputError.
void require_status(const OwnLaw& law, const TomlReader& root);

}  // namespace wearwell::ownlaw
