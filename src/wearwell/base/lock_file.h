#pragma once

#include <filesystem>
#include <functional>

#include "wearwell/base/disk.h"

namespace wearwell {

/// An exclusive lock between processes of wearwell for reading, changing and replacing a file,
/// independent of links. It is a hidden empty file `.NAME.lock` beside it, removed at the end.
class LockFile {
 public:
  /// Waits for another holder and calls `waiting` once before. Throws InputError or MachineError if
  /// locking is impossible.
  LockFile(const std::filesystem::path& file, const std::function<void()>& waiting);
  ~LockFile();
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;

  /// The lock of a file.
  static std::filesystem::path beside(const std::filesystem::path& file);

 private:
  bool take(bool wait);

  std::filesystem::path path_;
  Descriptor lock_;
};

}  // namespace wearwell
