#include "wearwell/base/disk.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "wearwell/base/ending.h"
#include "wearwell/base/error.h"

namespace wearwell {
namespace fs = std::filesystem;

namespace {

constexpr std::string_view prefix = ".wearwell.unfinished.";
constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz234567";
constexpr std::size_t random_letters = 12;

bool is_of_the_request(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
    case ENOENT:
    case ENOTDIR:
    case EISDIR:
    case EEXIST:
    case ENOTEMPTY:
    case ENAMETOOLONG:
    case ELOOP:
    case EINVAL:
    case EBUSY:
    case EXDEV:
    case ETXTBSY:
    case ENXIO:
      return true;
    default:
      return false;
  }
}

bool means_no_locks(int error) {
  return error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP || error == EINVAL;
}

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}
Descriptor::Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

void fail_to_write(const fs::path& target, int error) {
  wait_if_ending();
  std::string message = fmt::format("cannot write to {}: {}", target.string(), strerror(error));
  if (is_of_the_request(error)) throw InputError(message);
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) message += " (is the disk full?)";
  throw MachineError(message);
}

fs::path behind_links(const fs::path& path) {
  constexpr int most_links = 40;  // the kernel's limit
  std::error_code error;
  // The system resolves `..`: after a link to a folder it is the parent of the link's target.
  const auto ending_in_a_name = [&](fs::path at) {
    if (!at.has_filename()) at = at.parent_path();
    return at.filename() == "." || at.filename() == ".." ? fs::weakly_canonical(at, error) : at;
  };
  fs::path at = ending_in_a_name(fs::absolute(path));
  for (int links = 0;; ++links) {
    const fs::path next = fs::read_symlink(at, error);
    if (error) break;
    if (links == most_links) fail_to_write(path, ELOOP);
    at = ending_in_a_name(at.parent_path() / next);
  }
  if (at == at.root_path()) return at;
  const fs::path parent = fs::weakly_canonical(at.parent_path(), error);
  return error ? at : parent / at.filename();
}

void write_all(const Descriptor& file, std::string_view content, const fs::path& target) {
  while (!content.empty()) {
    const ssize_t n = ::write(file.get(), content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_to_write(target, errno);
    content.remove_prefix(static_cast<std::size_t>(n));
  }
}

void flush_to_disk(const Descriptor& file, const fs::path& target) {
  int done = 0;
  while ((done = fsync(file.get())) != 0 && errno == EINTR) {
  }
  // Some file systems and devices do not support flushing.
  if (done != 0 && errno != EINVAL && errno != ENOSYS && errno != EOPNOTSUPP && errno != EROFS)
    fail_to_write(target, errno);
}

void flush_folder(const fs::path& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened) flush_to_disk(opened, folder);  // a folder may be writable but not readable
}

Descriptor create_file(const fs::path& file) {
  return Descriptor(
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
}

bool rename_new(const fs::path& from, const fs::path& to) {
  errno = 0;
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  struct stat there;
  if (lstat(to.c_str(), &there) == 0) {
    errno = EEXIST;
    return false;
  }
  return rename(from.c_str(), to.c_str()) == 0;
}

bool exchange(const fs::path& one, const fs::path& other) {
  errno = 0;
  return renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
}

fs::path staging_name(const fs::path& folder) {
  unsigned char random[random_letters];
  if (getrandom(random, sizeof random, 0) != static_cast<ssize_t>(sizeof random))
    throw MachineError(fmt::format("no random numbers from the system: {}", strerror(errno)));
  std::string name(prefix);
  for (const unsigned char each : random) name += letters[each % letters.size()];
  return folder / name;
}

bool is_staging_name(const std::string& name) {
  return name.size() == prefix.size() + random_letters && name.starts_with(prefix) &&
         name.find_first_not_of(letters, prefix.size()) == std::string::npos;
}

bool lock_staging(const Descriptor& opened, const fs::path& path, const fs::path& target) {
  if (flock(opened.get(), LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (error == EWOULDBLOCK) return false;
    // Without file locks there is no recovery, because abandoned names look like live ones.
    if (!means_no_locks(error)) {
      std::remove(path.c_str());
      fail_to_write(target, error);
    }
  }
  struct stat mine, there;
  return fstat(opened.get(), &mine) == 0 && lstat(path.c_str(), &there) == 0 &&
         is_same(mine, there);
}

StagingFolder make_staging_folder(const fs::path& place, const fs::path& target) {
  for (;;) {
    const fs::path path = staging_name(place);
    SignalBlocker now;
    if (mkdir(path.c_str(), 0700) != 0) {
      if (errno == EEXIST) continue;
      fail_to_write(target, errno);
    }
    Descriptor opened(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!opened) {
      const int error = errno;
      if (error == ENOENT) continue;  // another process considered it abandoned and removed it
      rmdir(path.c_str());
      fail_to_write(target, error);
    }
    if (!lock_staging(opened, path, target)) continue;  // the same here
    now.note(path, true);
    return {path, std::move(opened)};
  }
}

void for_each_abandoned(const fs::path& folder,
                        const std::function<void(const fs::path& path, bool is_folder)>& heal) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (is_staging_name(at->path().filename().string())) found.push_back(at->path());
  }
  for (const fs::path& path : found) {
    const Descriptor opened(::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat mine, there;
    if (!opened || fstat(opened.get(), &mine) != 0 || mine.st_uid != geteuid()) continue;
    if (!S_ISREG(mine.st_mode) && !S_ISDIR(mine.st_mode)) continue;
    if (flock(opened.get(), LOCK_EX | LOCK_NB) != 0) continue;
    if (lstat(path.c_str(), &there) != 0 || !is_same(mine, there)) continue;
    heal(path, S_ISDIR(mine.st_mode));
  }
}

}  // namespace wearwell
