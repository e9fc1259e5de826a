#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wearwell/base/staged_folder.h"

namespace wearwell {

/// A folder of results that is written completely or not at all (StagedFolder). It also contains
/// `results.sha1`, a list of the written files with SHA-1 for `sha1sum`. Only listed and unchanged
/// files are replaced.
class ResultFolder {
 public:
  /// Throws InputError if `target` is neither an earlier result nor an empty folder, or is not
  /// writable; MachineError if the machine failed.
  explicit ResultFolder(const std::filesystem::path& target);

  const std::filesystem::path& path() const { return folder_.target(); }

  /// Throws MachineError if writing fails.
  void write(const std::string& name, std::string_view content);

  /// Keeps files that others put into the target in the meantime. Throws InputError if one has the
  /// name of a result, MachineError if writing fails; the target is then unchanged.
  void commit();

 private:
  StagedFolder folder_;
  std::string list_;
};

/// Completes or removes the interrupted commit of a killed run.
void recover_results(const std::filesystem::path& target);

/// Replaces one file of a result folder and its line in the list atomically (StagedFolder); without
/// a list, only the file. Throws InputError if another run wrote there in the meantime.
void replace_result(const std::filesystem::path& folder, const std::string& name,
                    std::string_view content);

}  // namespace wearwell
