#pragma once

#include <string>

namespace wearwell::workbench {

/// A word for a shell, quoted where needed.
std::string quoted_word(const std::string& text);

}  // namespace wearwell::workbench
