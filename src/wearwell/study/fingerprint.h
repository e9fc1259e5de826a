#pragma once

#include <filesystem>
#include <string>

namespace wearwell {

/// SHA-1 of a file, 40 hexadecimal digits, as `sha1sum` prints it: says whether two people have the
/// same data. Throws InputError when the file cannot be read.
std::string sha1(const std::filesystem::path& file);

}  // namespace wearwell
