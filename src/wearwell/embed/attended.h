#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include "wearwell/base/monitor.h"

namespace wearwell::embed {

/// How far work is, as it may be told on another thread.
struct ProgressSnapshot {
  std::string what;
  long long done = 0, total = 0;
  double seconds = 0;
};

/// Called on the thread that waits, some twenty times a second, with what is new; what it throws stops the work.
using Look = std::function<void(const std::optional<ProgressSnapshot>&)>;

/// Does `work`, a function of a Monitor, on a thread of its own, while this one looks after its user. `Away` is what this
/// thread holds while it waits: an interpreter's lock let go, or nothing. Returns when the work has ended, with what it
/// threw; or, where `look` threw meanwhile, with that.
template <class Away, class Work>
void attended(const Work& work, const Look& look) {
  constexpr std::chrono::milliseconds look_every{50};
  std::mutex mutex;
  std::condition_variable changed;
  std::stop_source stop;
  std::optional<ProgressSnapshot> fresh;
  bool done = false;
  std::exception_ptr thrown, raised;
  std::thread worker([&] {
    try {
      work(Monitor{.progress =
                       [&](const Step& step) {
                         const std::lock_guard lock(mutex);
                         fresh = ProgressSnapshot{std::string(step.what), step.done, step.total,
                                                  step.seconds};
                       },
                   .stop = stop.get_token()});
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    done = true;
    changed.notify_all();
  });
  for (bool ended = false; !ended;) {
    std::optional<ProgressSnapshot> news;
    {
      const Away away;
      std::unique_lock lock(mutex);
      ended = changed.wait_for(lock, look_every, [&] { return done; });
      news = std::exchange(fresh, {});
    }
    if (raised) continue;
    try {
      look(news);
    } catch (...) {
      raised = std::current_exception();
      stop.request_stop();
    }
  }
  {
    const Away away;
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace wearwell::embed
