#pragma once

#include <csignal>
#include <filesystem>

namespace wearwell {

/// From now on SIGINT, SIGTERM and SIGHUP end the program after removing half-written files.
/// Ignored signals stay ignored.
void remove_half_written_on_signals();

/// If the end has begun, waits for it, because errors are then caused by removed files.
void wait_if_ending();

/// While it exists, a signal cannot end the program between a change on disk and its registration.
/// It should live for only a few system calls and must not be nested.
class SignalBlocker {
 public:
  SignalBlocker();
  ~SignalBlocker();
  SignalBlocker(const SignalBlocker&) = delete;
  SignalBlocker& operator=(const SignalBlocker&) = delete;

  /// Registers `path` (absolute) for removal by a terminating signal, in reverse order of
  /// registration. A folder is removed only if it is empty.
  void note(const std::filesystem::path& path, bool is_folder);
  /// The same for a folder with all its content.
  void note_tree(const std::filesystem::path& path);
  /// Unregisters `path` and everything inside it, because it is complete or removed.
  void unregister(const std::filesystem::path& path);

 private:
  sigset_t before_;
};

}  // namespace wearwell
