#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/named_columns.h"

namespace wearwell::in_service {

/// Whether one of the headings has this name, with or without a unit of the dimension `si` (empty:
/// a label).
bool has_column(const std::vector<std::string>& headings, const std::string& name,
                const std::string& si);

/// The column of numbers of this name, by its heading. Throws InputError if there is none, or two, or
/// its unit is missing or wrong.
fleet::UnitColumn column_by_heading(const std::vector<std::string>& headings,
                                    const std::string& name, const std::string& si,
                                    const std::string& source);

/// Throws InputError: the table has no column `name`; `hint` is what --columns would state.
[[noreturn]] void fail_without_column(const std::string& name, const std::string& hint,
                                      const std::vector<std::string>& headings,
                                      const std::string& source);

}  // namespace wearwell::in_service
