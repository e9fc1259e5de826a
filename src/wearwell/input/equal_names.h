#pragma once

#include <string>
#include <vector>

namespace wearwell {

/// Throws InputError, which names `source` and both columns, where two of a table's headings are the same or differ by capital letters
/// only: a name would mean either. Empty headings have no name.
void refuse_equal_names(const std::vector<std::string>& names, const std::string& source);

}  // namespace wearwell
