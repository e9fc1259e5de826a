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
#include "wearwell/base/stoppable.h"

namespace wearwell::embed {

/// The progress of work, to be read on another thread.
struct ProgressSnapshot {
  std::string what;
  long long done = 0, total = 0;
  double seconds = 0;
};

/// Called on the waiting thread, some twenty times a second, with new progress; an exception stops
/// the work.
using Look = std::function<void(const std::optional<ProgressSnapshot>&)>;

/// Runs `work`, a function of a Monitor, on its own thread, while this thread serves its user; its
/// loops without a Monitor stop too (`check_stop`).
/// `Away` is what this thread holds while it waits: a released interpreter lock, or nothing.
/// Returns when the work has ended, and rethrows its exception, or that of `look` if it threw
/// meanwhile.
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
      const Monitor monitor{.progress =
                                [&](const Step& step) {
                                  const std::lock_guard lock(mutex);
                                  fresh = ProgressSnapshot{std::string(step.what), step.done,
                                                           step.total, step.seconds};
                                },
                            .stop = stop.get_token()};
      stoppable(monitor.stop, [&] { work(monitor); });
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
