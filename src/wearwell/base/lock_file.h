#pragma once

#include <filesystem>
#include <functional>

#include "wearwell/base/disk.h"

namespace wearwell {

/// While it lives, no other process of wearwell holds one for the same file, by whatever link:
/// for reading a file, changing it and putting it back. A hidden empty file `.NAME.lock` beside it,
/// which goes again.
class LockFile {
 public:
  /// Waits for another; `waiting` is called once before. Throws InputError or MachineError where
  /// nothing can be locked.
  LockFile(const std::filesystem::path& file, const std::function<void()>& waiting);
  ~LockFile();
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;

 private:
  bool take(bool wait);

  std::filesystem::path path_;
  Descriptor lock_;
};

}  // namespace wearwell
