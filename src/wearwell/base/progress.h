#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "wearwell/base/monitor.h"

namespace wearwell {

/// Counts the steps of a long computation, part by part: reports to a monitor ten times a second,
/// and throws `Cancelled` once it requests a stop. Thread-safe.
class Progress {
 public:
  /// `what`: the steps, "iterations".
  Progress(const Monitor& monitor, std::string what);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// The next part of the work, reported at once: its steps are counted and timed from here.
  /// `total`: 0 if unknown.
  void begin(std::string what, long long total = 0);

  void advance(long long steps);

  /// Throws `Cancelled` if the monitor requests it.
  void look() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::mutex mutex_;
  const Monitor& monitor_;
  std::string what_;
  Clock::time_point start_, next_;  // of the part; of the next report
  long long total_ = 0, done_ = 0;
};

/// Steps of one thread, forwarded in hundreds so that threads do not wait for each other.
class ProgressSteps {
 public:
  /// `progress` may be nullptr.
  explicit ProgressSteps(Progress* progress) : progress_(progress) {}
  ProgressSteps(const ProgressSteps&) = delete;
  ProgressSteps& operator=(const ProgressSteps&) = delete;

  /// Throws `Cancelled`.
  void step() {
    if (++pending_ < batch) return;
    pending_ = 0;
    if (progress_) progress_->advance(batch);
  }

 private:
  static constexpr int batch = 100;
  Progress* progress_;
  int pending_ = 0;
};

}  // namespace wearwell
