#pragma once

#include <filesystem>
#include <string>

namespace wearwell {

/// A file that is read once, so that the saved copy is identical to the text that was used.
struct TextFile {
  std::filesystem::path path;
  std::string text;
};
/// Throws InputError if it is missing or unreadable.
TextFile read_text_file(const std::filesystem::path& file);

}  // namespace wearwell
