#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/table_settings.h"

namespace wearwell {

/// The word ("Mittelwert") of a summary row: it begins with a word for mean, sum or standard
/// deviation, in English, German, French or Spanish, and contains a number. Empty for other rows,
/// and if `settings` state that all rows are data.
std::string summary_in(const std::vector<std::string_view>& cells, const TableSettings& settings);

/// Whether a cell marks a units row: "Unit", "Einheit", "Unité".
bool is_units_word(std::string_view cell);

}  // namespace wearwell
