#pragma once

#include <filesystem>

#include "wearwell/base/disk.h"

namespace wearwell {

/// A folder for what is needed during a run only. It goes with its object, with all that is in it, also when a
/// signal ends the program; what a kill leaves is removed by the next start that writes in that place.
class ScratchFolder {
 public:
  /// In `parent`, hidden. Throws as fail_to_write(parent).
  explicit ScratchFolder(const std::filesystem::path& parent);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  /// Absolute, empty at first.
  const std::filesystem::path& path() const { return path_; }

 private:
  StagingFolder hidden_;
  std::filesystem::path path_;
};

}  // namespace wearwell
