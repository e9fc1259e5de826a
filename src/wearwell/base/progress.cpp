#include "wearwell/base/progress.h"

#include <utility>

namespace wearwell {
namespace {

constexpr std::chrono::milliseconds interval(100);

}  // namespace

Progress::Progress(const Monitor& monitor, std::string what)
    : monitor_(monitor), what_(std::move(what)), start_(Clock::now()), next_(start_) {}

void Progress::begin(std::string what, long long total) {
  look();
  const std::lock_guard lock(mutex_);
  what_ = std::move(what);
  total_ = total;
  done_ = 0;
  start_ = Clock::now();
  next_ = start_ + interval;
  if (monitor_.progress) monitor_.progress({what_, 0, total_, 0});
}

void Progress::look() const {
  if (monitor_.stop.stop_requested()) throw Cancelled();
}

void Progress::advance(long long steps) {
  look();
  if (!monitor_.progress) return;
  const std::lock_guard lock(mutex_);
  done_ += steps;
  const auto now = Clock::now();
  if (now < next_) return;
  next_ = now + interval;
  monitor_.progress({what_, done_, total_, std::chrono::duration<double>(now - start_).count()});
}

}  // namespace wearwell
