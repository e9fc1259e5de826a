#pragma once

#include <atomic>
#include <memory>
#include <stop_token>

namespace wearwell {

/// A request to stop some work, for all threads that do a part of it.
struct StopSignal {
  std::stop_token requested = {};
  std::atomic<bool> ended = false;  ///< the work is done: threads that still hold this ignore it
};

/// The signal of the work that this thread does; null without one.
std::shared_ptr<const StopSignal> current_stop_signal();

/// Until its end this thread works under a signal (null: under none). Loops deep in the library,
/// which have no Monitor, find the signal by `check_stop`.
class StopScope {
 public:
  explicit StopScope(std::shared_ptr<const StopSignal> signal);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  std::shared_ptr<const StopSignal> before_;
};

/// Sets the signal of this thread without an end; for threads of a pool.
void set_stop_signal(std::shared_ptr<const StopSignal> signal);

/// Throws `Cancelled` once the signal of this thread is requested. Takes a few nanoseconds, so that
/// it suits loops whose steps take longer than that.
void check_stop();

}  // namespace wearwell
