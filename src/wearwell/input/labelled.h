#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/columns.h"

namespace wearwell {

/// The heading among `headings` that is "name [unit]" with a unit of the dimension of `si`; where
/// a plain number will do so will the name alone. Throws InputError that names `source` and the nearest
/// heading, the unit that is missing or wrong, or both headings where two have the name.
ColumnChoice find_labelled(const std::vector<std::string>& headings, std::string_view name,
                           std::string_view si, const std::string& source);
ColumnChoice find_labelled(const Table& table, std::string_view name, std::string_view si);

}  // namespace wearwell
