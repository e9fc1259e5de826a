#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wearwell/base/staged_folder.h"

namespace wearwell {

/// A folder of results that appears whole or not at all (StagedFolder). Beside the results it holds
/// `results.sha1`, the list of what wearwell wrote with a SHA-1 each, as `sha1sum` checks it: only
/// what is listed and unchanged is ever replaced.
class ResultFolder {
 public:
  /// Throws InputError when `target` is something else than an earlier result or an empty folder,
  /// or cannot be written, MachineError when the machine is at fault.
  explicit ResultFolder(const std::filesystem::path& target);

  const std::filesystem::path& path() const { return folder_.target(); }

  /// Throws MachineError when the disk refuses.
  void write(const std::string& name, std::string_view content);

  /// What others put into the target meanwhile stays there. Throws InputError when that has the
  /// name of a result, MachineError when the disk refuses: the target is as it was then.
  void commit();

 private:
  StagedFolder folder_;
  std::string list_;
};

/// What a run that was killed had begun to put into place is brought to its end, or removed.
void recover_results(const std::filesystem::path& target);

/// Replaces one file of a result folder and its line in the list, both or none (StagedFolder); of a
/// folder without a list, the file alone. Throws InputError when another run wrote there meanwhile.
void replace_result(const std::filesystem::path& folder, const std::string& name,
                    std::string_view content);

}  // namespace wearwell
