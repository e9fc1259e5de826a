#include "wearwell/report/result_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "wearwell/base/error.h"

namespace wearwell {
namespace fs = std::filesystem;

ResultFolder::ResultFolder(fs::path target) : target_(fs::absolute(target).lexically_normal()) {
  if (!target_.has_filename()) target_ = target_.parent_path();
  const std::string name = target_.string();
  std::error_code error;
  if (fs::exists(target_, error)) {
    if (!fs::is_directory(target_, error)) {
      throw InputError(fmt::format("cannot write to {}: it is not a folder", name));
    }
    if (!fs::is_empty(target_, error) && !fs::exists(target_ / "summary.json", error)) {
      throw InputError(
          fmt::format("will not replace {}: it holds something else than results", name));
    }
  }
  const fs::path parent = target_.parent_path();
  for (fs::path missing = parent; !fs::exists(missing, error); missing = missing.parent_path()) {
    made_parent_ = missing;
  }
  fs::create_directories(parent, error);
  std::string pattern = (parent / fmt::format(".{}.XXXXXX", target_.filename().string())).string();
  if (error || !mkdtemp(pattern.data())) {
    throw InputError(fmt::format("cannot write to {}: {}", parent.string(),
                                 error ? error.message() : std::strerror(errno)));
  }
  staging_ = pattern;
  fs::permissions(staging_,
                  fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                      fs::perms::others_read | fs::perms::others_exec,
                  error);
}

ResultFolder::~ResultFolder() {
  std::error_code ignored;
  if (!staging_.empty()) fs::remove_all(staging_, ignored);
  if (!made_parent_.empty()) fs::remove_all(made_parent_, ignored);
}

void ResultFolder::write(const std::string& name, const std::string& content) const {
  std::ofstream stream(staging_ / name, std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) {
    throw MachineError(
        fmt::format("cannot write {} for {}: is the disk full?", name, target_.string()));
  }
}

void ResultFolder::copy(const fs::path& file, const std::string& name) const {
  std::error_code error;
  fs::copy_file(file, staging_ / name, error);
  if (error) throw MachineError(fmt::format("cannot copy {}: {}", file.string(), error.message()));
}

void ResultFolder::commit() {
  std::error_code error;
  const fs::path old = staging_.string() + ".old";
  const bool replaces = fs::exists(target_);
  if (replaces) fs::rename(target_, old, error);
  if (!error) fs::rename(staging_, target_, error);
  if (error) {
    std::error_code ignored;
    if (replaces && fs::exists(old)) fs::rename(old, target_, ignored);
    throw MachineError(
        fmt::format("cannot put results at {}: {}", target_.string(), error.message()));
  }
  staging_.clear();
  made_parent_.clear();
  fs::remove_all(old, error);
}

void replace_file(const fs::path& file, const std::string& content) {
  const fs::path staging = file.string() + ".new";
  std::ofstream stream(staging, std::ios::binary);
  if (!stream) throw InputError(fmt::format("cannot write to {}", file.parent_path().string()));
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  std::error_code error;
  if (stream) fs::rename(staging, file, error);
  if (!stream || error) {
    std::error_code ignored;
    fs::remove(staging, ignored);
    throw MachineError(fmt::format("cannot write {}: is the disk full?", file.string()));
  }
}

}  // namespace wearwell
