#include "wearwell/present/progress_line.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace wearwell {
namespace {

std::string described(const Step& step) {
  if (step.done == 0) return std::string(step.what);
  const auto done = static_cast<double>(step.done), total = static_cast<double>(step.total);
  const double rate = done / step.seconds;
  std::string line = fmt::format("{} {}, {:.0f} a second", step.done, step.what, rate);
  if (step.total >= step.done) {
    line += fmt::format(", {:.0f} %, {:.0f} s left", 100 * done / total,
                        std::ceil((total - done) / rate));
  }
  return line;
}

}  // namespace

ProgressLine::~ProgressLine() {
  if (!shown_) return;
  std::fputs("\r\033[K", terminal_);
  std::fflush(terminal_);
}

void ProgressLine::show(const Step& step) {
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
  if (!terminal_ || passed.count() < patience_) return;
  shown_ = true;
  std::fputs(("\r  " + described(step) + "\033[K").c_str(), terminal_);
  std::fflush(terminal_);
}

}  // namespace wearwell
