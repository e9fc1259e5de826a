#pragma once

#include <optional>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/recurrence/event_words.h"

namespace wearwell::recurrence {

/// Whether a row counts the failures since the row before of its unit, at unknown ages: data.grouped. Throws InputError if
/// data.columns.count is missing, or a key has no meaning with it.
bool is_grouped(const TomlReader& section);
/// The number of failures of each row; an end of observation without a number has none.
std::vector<std::size_t> read_counts(const TomlReader& columns, Table table,
                                     const std::optional<EventWords>& words);

}  // namespace wearwell::recurrence
