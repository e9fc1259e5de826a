#include "wearwell/input/text_file.h"

#include <fmt/format.h>

#include <fstream>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {

TextFile read_text_file(const std::filesystem::path& file) {
  constexpr std::size_t largest = 1 << 20;  // bytes
  const std::string name = valid_utf8(file.string());
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw InputError(fmt::format("no such file: {}", name));
  if (std::filesystem::is_directory(file, ignored)) {
    const bool has_study = std::filesystem::exists(file / "study.toml", ignored);
    throw InputError(fmt::format(
        "{} is a folder, not a study file{}", name,
        has_study ? fmt::format("; did you mean '{}'?", valid_utf8((file / "study.toml").string()))
                  : ""));
  }
  if (!std::filesystem::is_regular_file(file, ignored))
    throw InputError(fmt::format(
        "{} is a pipe or a device; a study must be a file, with its data beside it", name));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{} cannot be read (permissions?)", name));
  TextFile read{file, std::string(largest + 1, '\0')};
  stream.read(read.text.data(), static_cast<std::streamsize>(read.text.size()));
  if (stream.bad()) throw InputError(fmt::format("{} cannot be read completely", name));
  read.text.resize(static_cast<std::size_t>(stream.gcount()));
  if (read.text.size() > largest)
    throw InputError(fmt::format("{} is larger than 1 MB, the limit for a study file", name));
  return read;
}

}  // namespace wearwell
