#pragma once

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// What the rows of a table are: of lives, any column of two truth values may say how they ended; of
/// other measurements, one whose heading says so.
enum class RowKind { life, measurement };

/// Refuses a table with a column that looks as if it said how each life ended (life_status.h) where no key of [data.columns] and
/// no `sql` names it: all lives would be taken for failures. `data` is the section [data], whose list `unused` names
/// columns that say nothing of that. A column that calls every row a failure changes nothing and is let pass. Throws
/// InputError with both readings.
void refuse_idle_status(const TomlReader& data, const Table& table, RowKind kind);

}  // namespace wearwell
