#pragma once

#include <csignal>
#include <filesystem>

namespace wearwell {

/// From here on SIGINT, SIGTERM and SIGHUP end the program at once, as they do anyway, but not
/// before what is half written is removed. A signal that is ignored stays ignored.
void remove_half_written_on_signals();

/// Waits for the end when it has begun: what fails now fails because its files are gone.
void wait_if_ending();

/// While one lives, a signal ends the program before or after, never between a change of the disk
/// and the note of it; so it lives for a few system calls only. Not to be nested.
class SignalBlocker {
 public:
  SignalBlocker();
  ~SignalBlocker();
  SignalBlocker(const SignalBlocker&) = delete;
  SignalBlocker& operator=(const SignalBlocker&) = delete;

  /// `path` (absolute) goes when the program is ended by a signal; the last one noted goes first.
  /// A folder goes only when it is empty by then.
  void note(const std::filesystem::path& path, bool is_folder);
  /// Likewise a folder with all that is in it, whoever put it there.
  void note_tree(const std::filesystem::path& path);
  /// It is whole, or gone; and all that was noted within it.
  void unregister(const std::filesystem::path& path);

 private:
  sigset_t before_;
};

}  // namespace wearwell
