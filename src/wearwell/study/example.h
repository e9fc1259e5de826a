#pragma once

#include <filesystem>

#include "wearwell/study/model.h"

namespace wearwell {

/// Writes the example study of a model and its data into a folder, which may be missing or empty.
/// Returns the study file. Throws InputError when the folder holds something or cannot be written,
/// MachineError when the disk refuses.
std::filesystem::path write_example(const Model& model, const std::filesystem::path& folder);

/// The same of a first study and a copy of its data, which it names `data`.
std::filesystem::path write_scaffold(const Scaffold& study, const std::filesystem::path& data,
                                     const std::filesystem::path& folder);

}  // namespace wearwell
