#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "wearwell/base/disk.h"

namespace wearwell {

/// The treatment of a symbolic link at the target: follow it (for names given by the user), or
/// replace it (for names inside an untrusted folder).
enum class Links { follow, replace };

/// A file that is written completely or not at all. It is written under a random temporary name in
/// the same folder and moved to the target by `commit`. Without `commit` it is removed, also by a
/// terminating signal; after a kill the next StagedFile in that folder removes it. An existing
/// target keeps its permissions; a device or a pipe is written directly. Missing folders are
/// created, and removed without `commit`.
///
/// All throw InputError if the target cannot be written as requested (a folder, no permission) and
/// MachineError if the machine failed (disk full, read-only).
class StagedFile {
 public:
  explicit StagedFile(const std::filesystem::path& target, Links links = Links::follow);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  void write(std::string_view content) { write_all(file_, content, target_); }
  /// Returns when the file is on disk.
  void commit();

 private:
  void make_folders();
  void remove_folders();

  std::filesystem::path target_, staging_;   ///< no staging: written directly
  std::vector<std::filesystem::path> made_;  ///< created folders, outermost first
  Descriptor file_;
};

void write_file(const std::filesystem::path& target, std::string_view content,
                Links links = Links::follow);

}  // namespace wearwell
