#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <mutex>

namespace wearwell {

/// The early end of a search, and its progress reports. Shared by all threads.
class SearchControl {
 public:
  struct Limits {
    double seconds = std::numeric_limits<double>::infinity();
    const std::atomic<bool>* stop = nullptr;  ///< set by the user, e.g. on Ctrl-C; may be null
  };
  /// Called with the number of visited nodes, the bound on the score, the share done (0: unknown),
  /// seconds.
  using Report = std::function<void(double nodes, double bound, double share, double seconds)>;

  SearchControl(const Limits& limits, Report report)
      : limits_(limits), report_(std::move(report)) {}

  /// True if time is up, the user requested a stop, or a thread failed. Called for every node.
  bool stopped() {
    if (!stopped_ && ((limits_.stop && *limits_.stop) || seconds() >= limits_.seconds)) stop();
    return stopped_;
  }
  void stop() { stopped_ = true; }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  /// Passes on at most some reports a second.
  void report(double nodes, double bound, double share) {
    if (!report_) return;
    const std::lock_guard lock(mutex_);
    if (seconds() < next_) return;
    report_(nodes, bound, share, seconds());
    next_ = seconds() + every;
  }

 private:
  static constexpr double every = 0.3;  // seconds
  const Limits limits_;
  const Report report_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  double next_ = every;
};

}  // namespace wearwell
