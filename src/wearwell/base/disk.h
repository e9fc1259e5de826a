#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace wearwell {

/// An open file or folder, closed with its owner.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;

  explicit operator bool() const { return fd_ >= 0; }
  int get() const { return fd_; }

 private:
  int fd_;
};

/// "cannot write to TARGET: reason": InputError if another request would succeed (permission,
/// invalid name), MachineError if the machine failed (disk full, read-only or broken).
[[noreturn]] void fail_to_write(const std::filesystem::path& target, int error);

/// The absolute target of a write to `path`, after symbolic links, also for a target that does not
/// exist yet. Throws InputError for circular links.
std::filesystem::path behind_links(const std::filesystem::path& path);

/// Writes all bytes. Throws like fail_to_write(target).
void write_all(const Descriptor& file, std::string_view content,
               const std::filesystem::path& target);

/// Returns when the data, or the entries of a folder, are on disk. Throws like
/// fail_to_write(target).
void flush_to_disk(const Descriptor& file, const std::filesystem::path& target);
void flush_folder(const std::filesystem::path& folder);

/// Creates a new file, which must not exist, with permissions from the umask.
Descriptor create_file(const std::filesystem::path& file);

/// rename(2) without replacement: false if `to` exists. Both set errno, 0 on success.
bool rename_new(const std::filesystem::path& from, const std::filesystem::path& to);
/// Exchanges two entries atomically; false with EINVAL or ENOSYS if the file system does not
/// support it.
bool exchange(const std::filesystem::path& one, const std::filesystem::path& other);

/// Staged entries of a folder have a random name: `.wearwell.unfinished.` and twelve letters. They
/// are locked during the lifetime of their owner.
std::filesystem::path staging_name(const std::filesystem::path& folder);
bool is_staging_name(const std::string& name);
/// False if another process took it in the meantime. If locks are supported but locking fails,
/// removes the name and throws like fail_to_write(target), because an unlocked name looks
/// abandoned.
bool lock_staging(const Descriptor& opened, const std::filesystem::path& path,
                  const std::filesystem::path& target);

/// A hidden folder with such a name, and its lock.
struct StagingFolder {
  std::filesystem::path path;
  Descriptor lock;
};

/// Creates one in `place`; a terminating signal removes it if it is empty. Throws like
/// fail_to_write(target).
StagingFolder make_staging_folder(const std::filesystem::path& place,
                                  const std::filesystem::path& target);

/// Calls `heal` with each abandoned entry of a folder: it has such a name, belongs to this user,
/// and its owner has ended.
void for_each_abandoned(
    const std::filesystem::path& folder,
    const std::function<void(const std::filesystem::path& path, bool is_folder)>& heal);

}  // namespace wearwell
