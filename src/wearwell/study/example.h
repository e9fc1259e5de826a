#pragma once

#include <filesystem>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell {

/// Writes the example study of a model and its data into a folder, which may be missing or empty.
/// Returns the study file. Throws InputError if the folder is not empty or not writable,
/// MachineError if writing fails.
std::filesystem::path write_example(const Model& model, const std::filesystem::path& folder);

/// The same for a new study of the user's data; copies the data under the name `data`.
std::filesystem::path write_scaffold(const Scaffold& study, const std::filesystem::path& data,
                                     const std::filesystem::path& folder);

/// One text file in a new folder, in the same way.
std::filesystem::path write_new(const std::string& name, const std::string& text,
                                const std::filesystem::path& folder);

}  // namespace wearwell
