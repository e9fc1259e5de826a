#include "wearwell/input/fingerprint.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "wearwell/base/error.h"
#include "wearwell/base/sha1.h"
#include "wearwell/base/stop_scope.h"

namespace wearwell {

std::string sha1(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string digits = sha1_of(stream);
  if (!stream.eof()) throw InputError(fmt::format("cannot read {}", file.string()));
  return digits;
}

ReadFile::ReadFile(std::filesystem::path file) : file_(std::move(file)), before_(look()) {}

std::optional<ReadFile::State> ReadFile::look() const {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file_, error)) return {};
  const State state{std::filesystem::file_size(file_, error),
                    std::filesystem::last_write_time(file_, error)};
  return error ? std::nullopt : std::optional(state);
}

std::string ReadFile::sha1() const {
  if (!before_) return {};
  std::string digits = wearwell::sha1(file_);
  if (look() != before_)
    throw InputError(fmt::format("{} changed while it was read; try again", file_.string()));
  return digits;
}

std::string fingerprint(const std::string& quantity, const std::vector<double>& observed) {
  std::string text = quantity;
  for (const double value : observed) {
    check_stop();
    fmt::format_to(std::back_inserter(text), "\n{:.12g}", value);
  }
  return sha1_of(text);
}

}  // namespace wearwell
