#pragma once

#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

namespace wearwell {

/// A line that says how far long work is, how fast it goes and how long it will take, rewritten in
/// place ten times a second and wiped at the end. Nothing is shown of work that is done within
/// `patience`. Thread-safe.
class Progress {
 public:
  /// `terminal`: where to write; nullptr for nowhere. `what`: the steps, "iterations".
  Progress(std::FILE* terminal, std::string what,
           std::chrono::milliseconds patience = std::chrono::milliseconds(500));
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// There will be so many steps in all.
  void expect(long long total);

  void advance(long long steps);

 private:
  using Clock = std::chrono::steady_clock;

  std::mutex mutex_;
  std::FILE* terminal_;
  std::string what_;
  Clock::time_point start_, next_;
  long long total_ = 0, done_ = 0;
  bool shown_ = false;
};

/// Steps of one thread, handed on in batches so that threads do not wait for each other.
class ProgressSteps {
 public:
  /// `progress` may be nullptr.
  explicit ProgressSteps(Progress* progress) : progress_(progress) {}
  ~ProgressSteps() { flush(); }
  ProgressSteps(const ProgressSteps&) = delete;
  ProgressSteps& operator=(const ProgressSteps&) = delete;

  void step() {
    if (++pending_ == 100) flush();
  }

 private:
  void flush() {
    if (progress_ && pending_ > 0) progress_->advance(pending_);
    pending_ = 0;
  }

  Progress* progress_;
  int pending_ = 0;
};

}  // namespace wearwell
