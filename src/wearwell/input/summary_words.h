#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/table_settings.h"

namespace wearwell {

/// "Mittelwert" of a row that such a word begins (mean, sum, standard deviation, in English, German, French and
/// Spanish) and that holds a number; empty of other rows, and where `settings` say that all rows are data.
std::string summary_in(const std::vector<std::string_view>& cells, const TableSettings& settings);

/// Whether a cell names a row of units: "Unit", "Einheit", "Unité".
bool is_units_word(std::string_view cell);

}  // namespace wearwell
