#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wearwell {

/// SHA-1 of a file, 40 hexadecimal digits, as `sha1sum` prints it: says whether two people have the
/// same data. Throws InputError when the file cannot be read.
std::string sha1(const std::filesystem::path& file);

/// SHA-1 of what was observed, to 12 digits (so that the unit of a column does not matter): equal
/// for studies of the same data, however they read them.
std::string fingerprint(const std::string& quantity, const std::vector<double>& observed);

}  // namespace wearwell
