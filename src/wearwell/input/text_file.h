#pragma once

#include <filesystem>
#include <string>

namespace wearwell {

/// A file that is read once, so that what is kept of it is what was used.
struct TextFile {
  std::filesystem::path path;
  std::string text;
};
/// Throws InputError when there is none or it cannot be read.
TextFile read_text_file(const std::filesystem::path& file);

}  // namespace wearwell
