#include "wearwell/base/progress.h"

#include <utility>

namespace wearwell {

Progress::Progress(const Monitor& monitor, std::string what)
    : monitor_(monitor), what_(std::move(what)), start_(Clock::now()), next_(start_) {}

void Progress::expect(long long total) {
  const std::lock_guard lock(mutex_);
  total_ = total;
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
  next_ = now + std::chrono::milliseconds(100);
  monitor_.progress({what_, done_, total_, std::chrono::duration<double>(now - start_).count()});
}

}  // namespace wearwell
