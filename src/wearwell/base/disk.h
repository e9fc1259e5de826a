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

/// "cannot write to TARGET: reason": InputError when another request would do (permission, a name
/// that cannot be), MachineError when the machine is at fault (disk full, read-only or broken).
[[noreturn]] void fail_to_write(const std::filesystem::path& target, int error);

/// Where a write to `path` ends: absolute, symbolic links followed, also to what does not exist
/// yet. Throws InputError when links go round.
std::filesystem::path behind_links(const std::filesystem::path& path);

/// Writes all of it. Throws as fail_to_write(target).
void write_all(const Descriptor& file, std::string_view content,
               const std::filesystem::path& target);

/// Returns when the disk has it; the same for the entries of a folder. Throws likewise.
void flush_to_disk(const Descriptor& file, const std::filesystem::path& target);
void flush_folder(const std::filesystem::path& folder);

/// Opens a new file, which must not exist, with the rights that the umask leaves.
Descriptor create_file(const std::filesystem::path& file);

/// rename(2) that leaves alone what is at `to`: false when there is something.
/// Both set errno, 0 on success.
bool rename_new(const std::filesystem::path& from, const std::filesystem::path& to);
/// Two entries change places in one step; false with EINVAL or ENOSYS where the file system cannot.
bool exchange(const std::filesystem::path& one, const std::filesystem::path& other);

/// What is staged in a folder before it takes its place has a name that nobody can foresee:
/// `.wearwell.unfinished.` and twelve letters. It is locked as long as its owner lives.
std::filesystem::path staging_name(const std::filesystem::path& folder);
bool is_staging_name(const std::string& name);
/// False when another took it in the meantime. When the lock fails where locks are, the name is
/// removed again, and it throws as fail_to_write(target): the next to look there, this program
/// among them, would take it for abandoned.
bool lock_staging(const Descriptor& opened, const std::filesystem::path& path,
                  const std::filesystem::path& target);

/// A hidden folder of such a name, and its lock.
struct StagingFolder {
  std::filesystem::path path;
  Descriptor lock;
};

/// Makes one in `place`; a signal that ends the program removes it when it is empty. Throws as
/// fail_to_write(target).
StagingFolder make_staging_folder(const std::filesystem::path& place,
                                  const std::filesystem::path& target);

/// Calls `heal` with each entry of a folder that has such a name, is of this user and whose owner
/// has ended without removing it.
void for_each_abandoned(
    const std::filesystem::path& folder,
    const std::function<void(const std::filesystem::path& path, bool is_folder)>& heal);

}  // namespace wearwell
