#include "wearwell/base/progress.h"

#include <fmt/format.h>

#include <cmath>

namespace wearwell {

Progress::Progress(std::FILE* terminal, std::string what, std::chrono::milliseconds patience)
    : terminal_(terminal), what_(std::move(what)), start_(Clock::now()), next_(start_ + patience) {}

Progress::~Progress() {
  if (!shown_) return;
  std::fputs("\r\033[K", terminal_);
  std::fflush(terminal_);
}

void Progress::expect(long long total) {
  const std::lock_guard lock(mutex_);
  total_ = total;
}

void Progress::advance(long long steps) {
  if (!terminal_) return;
  const std::lock_guard lock(mutex_);
  done_ += steps;
  const auto now = Clock::now();
  if (now < next_ || done_ == 0) return;
  next_ = now + std::chrono::milliseconds(100);
  shown_ = true;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double rate = static_cast<double>(done_) / seconds;
  std::string line = fmt::format("\r  {} {}, {:.0f} a second", done_, what_, rate);
  if (total_ >= done_) {
    line += fmt::format(", {:.0f} %, {:.0f} s left",
                        100.0 * static_cast<double>(done_) / static_cast<double>(total_),
                        std::ceil(static_cast<double>(total_ - done_) / rate));
  }
  std::fputs((line + "\033[K").c_str(), terminal_);
  std::fflush(terminal_);
}

}  // namespace wearwell
