#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/base/disk.h"

namespace wearwell {

/// A folder of files that is written completely or not at all. The files are written to a hidden
/// folder, and `commit` moves them into place. If the target is missing or contains only replaced
/// files, it exchanges two folders atomically. If the target must stay (working folder, mount
/// point, other content), it moves the files one by one, with a journal on disk. Without `commit`
/// they are removed, also by a terminating signal. After a kill, the next run that writes in that
/// place removes them or completes the commit. A symbolic link is followed; an existing target
/// keeps its permissions.
///
/// All throw InputError if the target cannot be written as requested (not a folder, no permission)
/// and MachineError if the machine failed (disk full, read-only).
class StagedFolder {
 public:
  /// `own`: the files in the target that can be replaced.
  explicit StagedFolder(const std::filesystem::path& target,
                        const std::vector<std::string>& own = {});
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// The absolute path of the target.
  const std::filesystem::path& target() const { return target_; }

  /// `name`: a file, or a file in a subfolder, "tables/life.csv".
  void write(const std::string& name, std::string_view content);

  /// Keeps a file of the target unchanged, as a hard link if possible, else as a copy.
  void keep(const std::string& name);

  /// Replaces the files of `replaced` in the target and keeps all others. Throws InputError without
  /// any change if a kept file has the name of a written one. Returns when everything is on disk.
  void commit(const std::vector<std::string>& replaced);

 private:
  void make_folder(const std::filesystem::path& folder, unsigned mode);
  std::filesystem::path staged(const std::string& name);
  void open_area(const std::filesystem::path& place);
  void write_journal(const std::vector<std::string>& replaced);
  void put_into_place();

  std::filesystem::path target_;
  std::filesystem::path place_;   ///< parent of the hidden folder
  std::filesystem::path area_;    ///< the hidden folder
  std::filesystem::path within_;  ///< path from `place_` to the target; empty: files are moved into
                                  ///< the target
  Descriptor lock_;
  std::vector<std::string> names_;
};

/// The files of a folder, with files of subfolders as "tables/life.csv" and empty subfolders by
/// name. Empty if the folder does not exist.
std::vector<std::string> files_in(const std::filesystem::path& folder);

/// Removes half-written files of killed programs in `folder`, or completes their commits.
void recover_folder(const std::filesystem::path& folder);

}  // namespace wearwell
