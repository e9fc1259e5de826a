#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "wearwell/base/disk.h"

namespace wearwell {

/// A symbolic link where a file is to be written: write what it points to, as for a name that a
/// user gives, or put the file in its place, as for a name within a folder that may come from
/// anybody.
enum class Links { follow, replace };

/// A file that appears whole or not at all: written under a name that nobody can foresee in the
/// same folder, and put in the target's place by `commit`. Without that it goes, also when a signal
/// ends the program; what a kill leaves is removed by the next StagedFile in that folder. A target
/// that exists keeps its permissions; a device or a pipe is written as it stands. Folders of the target that are
/// missing are made, and go again without `commit`.
///
/// All throw InputError when the target cannot be written as asked (a folder, no permission) and
/// MachineError when the machine is at fault (disk full, read-only).
class StagedFile {
 public:
  explicit StagedFile(const std::filesystem::path& target, Links links = Links::follow);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  void write(std::string_view content) { write_all(file_, content, target_); }
  /// Returns when the disk has it.
  void commit();

 private:
  void make_folders();
  void remove_folders();

  std::filesystem::path target_, staging_;   ///< no staging: written as it stands
  std::vector<std::filesystem::path> made_;  ///< folders, the outermost first
  Descriptor file_;
};

void write_file(const std::filesystem::path& target, std::string_view content,
                Links links = Links::follow);

}  // namespace wearwell
