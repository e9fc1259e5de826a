#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/base/disk.h"

namespace wearwell {

/// A folder of files that appears whole or not at all. The files wait in a hidden folder until
/// `commit` puts them into place: in one step, by exchanging two folders, where the target is
/// missing or holds nothing but what is replaced; one by one, by a list that is kept on disk, where
/// the target itself must stay (it is the working folder, a mount point, or holds more). Without
/// `commit` they go, also when a signal ends the program; what a kill leaves is removed, or brought
/// to its end, by the next start that writes in that place. A target that is a symbolic link is
/// what it points to; one that exists keeps its permissions.
///
/// All throw InputError when the target cannot be written as asked (no folder, no permission) and
/// MachineError when the machine is at fault (disk full, read-only).
class StagedFolder {
 public:
  /// `own`: the files in the target that are there to be replaced.
  explicit StagedFolder(const std::filesystem::path& target,
                        const std::vector<std::string>& own = {});
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Where the files will be: absolute.
  const std::filesystem::path& target() const { return target_; }

  /// `name`: of a file, or of one in a folder of the target, "tables/life.csv".
  void write(const std::string& name, std::string_view content);

  /// Takes over a file of the target as it is, without a copy where the file system has hard links.
  void keep(const std::string& name);

  /// The files of `replaced` in the target make room; whatever else is there stays. Throws
  /// InputError when one that stays has the name of one that was written: nothing is done then.
  /// Returns when the disk has all.
  void commit(const std::vector<std::string>& replaced);

 private:
  void make_folder(const std::filesystem::path& folder, unsigned mode);
  std::filesystem::path staged(const std::string& name);
  void open_area(const std::filesystem::path& place);
  void write_journal(const std::vector<std::string>& replaced);
  void put_into_place();

  std::filesystem::path target_;
  std::filesystem::path place_;   ///< the folder that holds the hidden one
  std::filesystem::path area_;    ///< the hidden folder
  std::filesystem::path within_;  ///< from `place_` to the target; empty: filled in the target
  Descriptor lock_;
  std::vector<std::string> names_;
};

/// The files of a folder, those of the folders in it as "tables/life.csv"; a folder that is empty as
/// itself. Nothing when there is none.
std::vector<std::string> files_in(const std::filesystem::path& folder);

/// Removes what killed programs left half written in `folder`, or completes what they had begun to
/// put into place.
void recover_folder(const std::filesystem::path& folder);

}  // namespace wearwell
