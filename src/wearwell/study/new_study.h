#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wearwell {

/// The trades that have a study to start from.
std::vector<std::string> new_study_trades();

/// Writes the example study of a trade and its data into a folder, which may be missing or empty.
/// Returns the study file. Throws InputError when the folder holds something or cannot be written,
/// MachineError when the disk refuses.
std::filesystem::path write_new_study(const std::string& trade,
                                      const std::filesystem::path& folder);

}  // namespace wearwell
