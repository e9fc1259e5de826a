#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace wearwell::workbench {

/// Results of the folder side by side, as `wearwell compare` has them: {text, answer, command, python}.
/// Throws InputError, also for fewer than two names, the same one twice or more than 20.
nlohmann::ordered_json comparison_answer(const std::filesystem::path& folder,
                                         const std::vector<std::string>& names);

/// The page of the same comparison.
std::string comparison_page_of(const std::filesystem::path& folder,
                               const std::vector<std::string>& names);

}  // namespace wearwell::workbench
