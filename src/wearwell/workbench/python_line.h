#pragma once

#include <string>
#include <utility>
#include <vector>

namespace wearwell::workbench {

/// A text as a literal of Python.
std::string python_text(const std::string& text);

/// The line that prints what `function` of the package answers about a folder: arguments without a
/// value are left out.
std::string python_question(const std::string& function, const std::string& folder,
                            const std::vector<std::pair<std::string, std::string>>& arguments);

}  // namespace wearwell::workbench
