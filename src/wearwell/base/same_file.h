#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wearwell {

/// A file of a command with its name for the user: "--trace", "the model".
struct NamedFile {
  std::string role;
  std::filesystem::path path;  ///< empty: not given
};

/// Throws InputError if an output is the same file as an input or another output, after resolving
/// names and links, also for files that do not exist yet. An output folder must not contain an
/// input.
void refuse_overwriting(const std::vector<NamedFile>& inputs,
                        const std::vector<NamedFile>& outputs);

}  // namespace wearwell
