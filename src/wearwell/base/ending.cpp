#include "wearwell/base/ending.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell {
namespace {

constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP};

enum class Kind { file, folder, tree };

struct HalfWritten {
  std::string path;
  Kind kind;
};

// The holder of the lock blocks the signals, so that the handler never waits for the interrupted
// thread and finds a consistent list.
std::atomic_flag lock = ATOMIC_FLAG_INIT;
std::vector<HalfWritten>& half_written() {
  static auto* list = new std::vector<HalfWritten>;  // outlives all static objects
  return *list;
}

std::atomic<bool> ending = false;

void take_lock() {
  constexpr timespec moment = {0, 100'000};
  while (lock.test_and_set()) nanosleep(&moment, nullptr);
}

// A signal handler must not call functions of <dirent.h>, because they allocate.
void remove_tree(int above, const char* name) {
  const int folder = openat(above, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder >= 0) {
    alignas(dirent64) char entries[2048];
    for (long size; (size = syscall(SYS_getdents64, folder, entries, sizeof entries)) > 0;) {
      bool removed = false;
      for (long at = 0; at < size;) {
        const auto* entry = reinterpret_cast<const dirent64*>(entries + at);
        at += entry->d_reclen;
        const std::string_view each = entry->d_name;
        if (each == "." || each == "..") continue;
        if (entry->d_type == DT_DIR) remove_tree(folder, entry->d_name);
        if (unlinkat(folder, entry->d_name, entry->d_type == DT_DIR ? AT_REMOVEDIR : 0) == 0)
          removed = true;
      }
      if (removed) lseek(folder, 0, SEEK_SET);  // removal may have moved later entries
    }
    close(folder);
  }
  unlinkat(above, name, AT_REMOVEDIR);
}

extern "C" void end_by(int signal) {
  take_lock();  // never released
  ending = true;
  std::vector<HalfWritten>& list = half_written();
  for (std::size_t i = list.size(); i-- > 0;) {
    switch (list[i].kind) {
      case Kind::file:
        unlink(list[i].path.c_str());
        break;
      case Kind::folder:
        rmdir(list[i].path.c_str());
        break;
      case Kind::tree:
        remove_tree(AT_FDCWD, list[i].path.c_str());
        break;
    }
  }
  struct sigaction standard = {};
  standard.sa_handler = SIG_DFL;
  sigaction(signal, &standard, nullptr);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  raise(signal);
}

}  // namespace

void remove_half_written_on_signals() {
  half_written();
  for (const int signal : ending_signals) {
    struct sigaction action = {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = end_by;
    for (const int other : ending_signals) sigaddset(&action.sa_mask, other);
    sigaction(signal, &action, nullptr);
  }
}

void wait_if_ending() {
  while (ending) pause();
}

SignalBlocker::SignalBlocker() {
  sigset_t all;
  sigemptyset(&all);
  for (const int signal : ending_signals) sigaddset(&all, signal);
  pthread_sigmask(SIG_BLOCK, &all, &before_);
  take_lock();
}

SignalBlocker::~SignalBlocker() {
  lock.clear();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void SignalBlocker::note(const std::filesystem::path& path, bool is_folder) {
  half_written().push_back({path.string(), is_folder ? Kind::folder : Kind::file});
}

void SignalBlocker::note_tree(const std::filesystem::path& path) {
  half_written().push_back({path.string(), Kind::tree});
}

void SignalBlocker::unregister(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::erase_if(half_written(), [&](const HalfWritten& each) {
    return each.path == name || each.path.starts_with(name + "/");
  });
}

}  // namespace wearwell
