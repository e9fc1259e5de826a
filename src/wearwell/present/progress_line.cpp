#include "wearwell/present/progress_line.h"

#include <fmt/format.h>

#include <cmath>

namespace wearwell {

ProgressLine::~ProgressLine() {
  if (!shown_) return;
  std::fputs("\r\033[K", terminal_);
  std::fflush(terminal_);
}

void ProgressLine::show(const Step& step) {
  if (!terminal_ || step.seconds < patience_ || step.done == 0) return;
  shown_ = true;
  const auto done = static_cast<double>(step.done), total = static_cast<double>(step.total);
  const double rate = done / step.seconds;
  std::string line = fmt::format("\r  {} {}, {:.0f} a second", step.done, step.what, rate);
  if (step.total >= step.done)
    line += fmt::format(", {:.0f} %, {:.0f} s left", 100 * done / total,
                        std::ceil((total - done) / rate));
  std::fputs((line + "\033[K").c_str(), terminal_);
  std::fflush(terminal_);
}

}  // namespace wearwell
