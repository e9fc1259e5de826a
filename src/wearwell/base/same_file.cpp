#include "wearwell/base/same_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>

#include "wearwell/base/disk.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace fs = std::filesystem;

namespace {

bool is_same(const fs::path& one, const fs::path& other) {
  struct stat a, b;
  if (stat(one.c_str(), &a) == 0 && stat(other.c_str(), &b) == 0) {
    // Writing to a device or a pipe does not overwrite data.
    if (!S_ISREG(a.st_mode) && !S_ISDIR(a.st_mode)) return false;
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
  }
  return behind_links(one) == behind_links(other);
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return false;
  for (fs::path up = behind_links(file); up.has_relative_path();) {
    up = up.parent_path();
    if (fs::equivalent(up, folder, error)) return true;
  }
  return false;
}

}  // namespace

void refuse_overwriting(const std::vector<NamedFile>& inputs,
                        const std::vector<NamedFile>& outputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (output->path.empty()) continue;
    const auto refuse = [&](const NamedFile& other, const char* how) {
      throw InputError(fmt::format("{} {} {} {} {}; nothing is written", output->role,
                                   output->path.string(), how, other.role, other.path.string()));
    };
    for (const NamedFile& input : inputs) {
      if (input.path.empty()) continue;
      if (is_same(output->path, input.path)) refuse(input, "would overwrite");
      if (lies_in(input.path, output->path)) refuse(input, "is a folder that contains");
    }
    for (auto earlier = outputs.begin(); earlier != output; ++earlier) {
      if (!earlier->path.empty() && is_same(output->path, earlier->path))
        refuse(*earlier, "is the same file as");
    }
  }
}

}  // namespace wearwell
