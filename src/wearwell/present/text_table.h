#pragma once

#include <string>
#include <vector>

namespace wearwell {

/// Rows of cells for a terminal, the first row being the heading; the first column is aligned left,
/// the others right. `words_last`: the last column holds words, aligned left.
std::string text_table(const std::vector<std::vector<std::string>>& rows, bool words_last = false);

}  // namespace wearwell
