#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace wearwell {

/// SHA-1 of a file, 40 hexadecimal digits, as `sha1sum` prints it: says whether two people have the
/// same data. Throws InputError when the file cannot be read.
std::string sha1(const std::filesystem::path& file);

/// A file while it is read by others: made before, asked after. Of what is no plain file (a pipe,
/// several files) nothing can be said: the SHA-1 is empty.
class ReadFile {
 public:
  explicit ReadFile(std::filesystem::path file);
  /// Throws InputError when the file was changed since.
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

/// SHA-1 of what was observed, to 12 digits (so that the unit of a column does not matter): equal
/// for studies of the same data, however they read them.
std::string fingerprint(const std::string& quantity, const std::vector<double>& observed);

}  // namespace wearwell
