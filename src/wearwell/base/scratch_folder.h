#pragma once

#include <filesystem>

#include "wearwell/base/disk.h"

namespace wearwell {

/// A temporary folder for a run. It is removed with its content at the end of the object's lifetime
/// and by terminating signals. After a kill, the next run that writes in that place removes it.
class ScratchFolder {
 public:
  /// Creates a hidden folder in `parent`. Throws like fail_to_write(parent).
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
