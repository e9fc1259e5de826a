#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/columns.h"

namespace wearwell {

/// The heading "name [unit]" with a unit of the dimension of `si`; the name alone suffices for
/// plain numbers. Throws InputError that names `source` and the nearest heading, the missing or
/// wrong unit, or both headings if two have the name. The message proposes other headings or, with
/// the name of an `option` that chooses columns, that option: columns of a database keep their names.
ColumnChoice find_labelled(const std::vector<std::string>& headings, std::string_view name,
                           std::string_view si, const std::string& source,
                           std::string_view option = {});
ColumnChoice find_labelled(const Table& table, std::string_view name, std::string_view si,
                           std::string_view option = {});

}  // namespace wearwell
