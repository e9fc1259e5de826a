#include "wearwell/base/ending.h"

#include <time.h>
#include <unistd.h>

#include <atomic>
#include <string>
#include <vector>

namespace wearwell {
namespace {

constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP};

struct HalfWritten {
  std::string path;
  bool is_folder;
};

// Whoever holds the lock has the signals blocked, so that the handler never waits for the thread
// that it interrupted, and finds the list whole.
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

extern "C" void end_by(int signal) {
  take_lock();  // for good
  ending = true;
  std::vector<HalfWritten>& list = half_written();
  for (std::size_t i = list.size(); i-- > 0;) {
    if (list[i].is_folder) {
      rmdir(list[i].path.c_str());
    } else {
      unlink(list[i].path.c_str());
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

Uninterrupted::Uninterrupted() {
  sigset_t all;
  sigemptyset(&all);
  for (const int signal : ending_signals) sigaddset(&all, signal);
  pthread_sigmask(SIG_BLOCK, &all, &before_);
  take_lock();
}

Uninterrupted::~Uninterrupted() {
  lock.clear();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void Uninterrupted::note(const std::filesystem::path& path, bool is_folder) {
  half_written().push_back({path.string(), is_folder});
}

void Uninterrupted::forget(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::erase_if(half_written(), [&](const HalfWritten& each) {
    return each.path == name || each.path.starts_with(name + "/");
  });
}

}  // namespace wearwell
