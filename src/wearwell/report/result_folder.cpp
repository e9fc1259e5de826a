#include "wearwell/report/result_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "wearwell/base/error.h"

namespace wearwell {
namespace fs = std::filesystem;

namespace {

// All that a result may hold: a folder with anything else in it is not ours to replace.
bool is_result(const std::string& name) {
  for (const char* file :
       {"summary.json", "predictions.csv", "plots.json", "report.html", "study.toml", "models.csv",
        "loo.csv", "coverage.csv", "pointwise.csv"}) {
    if (name == file) return true;
  }
  if (name == "model.json") return true;
  return name.starts_with("draws_") && name.ends_with(".csv");
}

void require_result(const std::string& name) {
  if (!is_result(name)) throw std::logic_error("no name for a file of results: " + name);
}

// Throws InputError unless `folder` is empty or holds an earlier result and nothing else.
void require_replaceable(const fs::path& folder) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("will not replace {}: {}", folder.string(), reason));
  };
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  if (error) refuse(error.message());
  bool empty = true;
  for (const fs::directory_entry& entry : entries) {
    empty = false;
    const std::string name = entry.path().filename().string();
    if (!is_result(name) || !entry.is_regular_file(error)) {
      refuse(fmt::format("it holds {}, which is no result", name));
    }
  }
  if (!empty && !fs::exists(folder / "summary.json", error)) {
    refuse("it is not empty and holds no summary.json");
  }
}

// Removes `folder` and those above it up to `last`, as far as nobody has put anything into them.
void remove_empty(fs::path folder, const fs::path& last) {
  std::error_code ignored;
  while (fs::remove(folder, ignored), folder != last) folder = folder.parent_path();
}

}  // namespace

ResultFolder::ResultFolder(fs::path target) : target_(fs::absolute(target).lexically_normal()) {
  if (!target_.has_filename()) target_ = target_.parent_path();
  const std::string name = target_.string();
  std::error_code error;
  if (fs::exists(target_, error)) {
    if (!fs::is_directory(target_, error)) {
      throw InputError(fmt::format("cannot write to {}: it is not a folder", name));
    }
    require_replaceable(target_);
  }
  const fs::path parent = target_.parent_path();
  for (fs::path missing = parent; !fs::exists(missing, error); missing = missing.parent_path()) {
    made_parent_ = missing;
  }
  fs::create_directories(parent, error);
  std::string pattern = (parent / ".wearwell.XXXXXX").string();
  if (error || !mkdtemp(pattern.data())) {
    const std::string reason = error ? error.message() : std::strerror(errno);
    if (!made_parent_.empty()) remove_empty(parent, made_parent_);
    throw InputError(fmt::format("cannot write to {}: {}", parent.string(), reason));
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
  if (!made_parent_.empty()) remove_empty(target_.parent_path(), made_parent_);
}

void ResultFolder::write(const std::string& name, const std::string& content) const {
  require_result(name);
  std::ofstream stream(staging_ / name, std::ios::binary);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) {
    throw MachineError(
        fmt::format("cannot write {} for {}: is the disk full?", name, target_.string()));
  }
}

void ResultFolder::copy(const fs::path& file, const std::string& name) const {
  require_result(name);
  std::error_code error;
  fs::copy_file(file, staging_ / name, error);
  if (error) throw MachineError(fmt::format("cannot copy {}: {}", file.string(), error.message()));
}

void ResultFolder::commit() {
  std::error_code error;
  const fs::path old = staging_.string() + ".old";
  const bool replaces = fs::exists(target_, error);
  if (replaces) fs::rename(target_, old, error);
  if (!error) fs::rename(staging_, target_, error);
  if (error) {
    std::error_code ignored;
    if (replaces && fs::exists(old, ignored)) fs::rename(old, target_, ignored);
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
