#include "wearwell/monitor/notices.h"

#include <fmt/format.h>

#include "wearwell/base/shown.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {

void Notices::tell(const std::string& subject, const std::string& text) {
  if (!stream_) return;
  const std::lock_guard lock(lock_);
  Subject& state = subjects_[subject];
  const auto now = std::chrono::steady_clock::now();
  const bool quiet_since = now - state.last >= std::chrono::seconds(10);
  if (quiet_since && state.left_out == 0) state.reported = 0;
  if (state.reported >= burst && !quiet_since) {
    ++state.left_out;
    return;
  }
  const std::string more =
      state.left_out ? fmt::format(" (and {} like it)", state.left_out) : std::string();
  const std::string line =
      fmt::format("{} {}: {}{}\n", iso_of_unix_ms(unix_ms_now()), subject, shown(text), more);
  std::fputs(line.c_str(), stream_);
  std::fflush(stream_);
  ++state.reported;
  state.left_out = 0;
  state.last = now;
}

}  // namespace wearwell::monitor
