#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace wearwell::workbench {

/// The path of a file or a result in the folder. Throws InputError for names that a page must not
/// use: with a slash, hidden, not UTF-8, longer than 200 bytes, or a link that leads out of the folder.
std::filesystem::path path_in(const std::filesystem::path& folder, const std::string& name);

/// The kind of a name: "table", "study" or "result"; "" for others.
std::string kind_of(const std::filesystem::path& file);

/// Whether the extension is one that tables have; that of studies, .toml.
bool is_table_name(const std::filesystem::path& file);
bool is_study_name(const std::filesystem::path& file);

/// Size and time of a file: another one means that it has been changed. Empty if there is none.
std::string stamp_of(const std::filesystem::path& file);

/// {"tables": [...], "studies": [...], "results": [...]}: names in the folder, sorted; at most 500
/// of a kind.
nlohmann::ordered_json listed_files(const std::filesystem::path& folder);

}  // namespace wearwell::workbench
