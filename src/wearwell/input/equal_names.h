#pragma once

#include <string>
#include <vector>

namespace wearwell {

/// Throws InputError that names `source` and both columns if two headings of a table are equal or
/// differ only in case, because a name would be ambiguous. Ignores empty headings.
void refuse_equal_names(const std::vector<std::string>& names, const std::string& source);

}  // namespace wearwell
