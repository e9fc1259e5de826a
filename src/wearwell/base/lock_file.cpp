#include "wearwell/base/lock_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "wearwell/base/ending.h"
#include "wearwell/base/error.h"

namespace wearwell {

std::filesystem::path LockFile::beside(const std::filesystem::path& file) {
  const std::filesystem::path target = behind_links(file);
  return target.parent_path() / fmt::format(".{}.lock", target.filename().string());
}

LockFile::LockFile(const std::filesystem::path& file, const std::function<void()>& waiting)
    : path_(beside(file)) {
  if (take(false)) return;
  waiting();
  while (!take(true)) {
  }
}

// False if another process has the lock, or had it and removed the file.
bool LockFile::take(bool wait) {
  Descriptor opened(
      ::open(path_.c_str(), O_RDONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666));
  if (!opened) fail_to_write(path_, errno);
  struct stat mine, there;
  if (fstat(opened.get(), &mine) != 0) fail_to_write(path_, errno);
  if (!S_ISREG(mine.st_mode) || mine.st_size != 0)
    throw InputError(fmt::format("{} exists but is not a lock file", path_.string()));
  if (wait) {
    while (flock(opened.get(), LOCK_EX) != 0) {
      if (errno != EINTR) fail_to_write(path_, errno);
    }
    flock(opened.get(), LOCK_UN);  // taken again below, with signals blocked
  }
  SignalBlocker now;
  if (flock(opened.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK || errno == EINTR) return false;
    fail_to_write(path_, errno);
  }
  if (lstat(path_.c_str(), &there) != 0 || there.st_dev != mine.st_dev ||
      there.st_ino != mine.st_ino)
    return false;
  now.note(path_, false);
  lock_ = std::move(opened);
  return true;
}

LockFile::~LockFile() {
  if (!lock_) return;
  SignalBlocker now;
  unlink(path_.c_str());
  now.unregister(path_);
}

}  // namespace wearwell
