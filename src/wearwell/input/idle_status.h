#pragma once

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// The meaning of a table's rows. For lives, any column of two truth values may be a status; for
/// other measurements, only a column with such a heading.
enum class RowKind { life, measurement };

/// Refuses a table with a column that looks like a status (life_status.h) but is not named by a key
/// of [data.columns] or by `sql`, because all lives would count as failures. The list `unused` of
/// the section `data` names columns to ignore. A column that marks every row as a failure is
/// accepted. Throws InputError that explains both readings.
void refuse_idle_status(const TomlReader& data, const Table& table, RowKind kind);

}  // namespace wearwell
