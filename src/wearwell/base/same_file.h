#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wearwell {

/// A file of a command, and how the user named it: "--trace", "the model".
struct NamedFile {
  std::string role;
  std::filesystem::path path;  ///< empty: not given
};

/// Throws InputError when a file that would be written is one that is read, or two that would be
/// written are one: by whatever names and links, and also when it does not exist yet. An output
/// that is a folder must not hold an input either.
void refuse_overwriting(const std::vector<NamedFile>& inputs,
                        const std::vector<NamedFile>& outputs);

}  // namespace wearwell
