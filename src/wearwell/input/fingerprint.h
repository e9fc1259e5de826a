#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace wearwell {

/// SHA-1 of a file, 40 hexadecimal digits as printed by `sha1sum`, to compare data files. Throws
/// InputError if the file cannot be read.
std::string sha1(const std::filesystem::path& file);

/// Detects changes of a file while other code reads it: construct it before reading, check it
/// after. The SHA-1 is empty for anything but a regular file (a pipe, several files).
class ReadFile {
 public:
  explicit ReadFile(std::filesystem::path file);
  /// Throws InputError if the file has changed.
  std::string sha1() const;

 private:
  struct State {
    std::uintmax_t size;
    std::filesystem::file_time_type time;
    bool operator==(const State&) const = default;
  };
  std::optional<State> look() const;

  std::filesystem::path file_;
  std::optional<State> before_;
};

/// SHA-1 of the observed values, rounded to 12 digits so that the unit of a column does not matter.
/// Equal for studies of the same data.
std::string fingerprint(const std::string& quantity, const std::vector<double>& observed);

}  // namespace wearwell
