#include "wearwell/monitor/source.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

namespace wearwell::monitor {

bool pause(std::chrono::milliseconds time, std::stop_token stop) {
  std::mutex lock;
  std::condition_variable_any changed;
  std::unique_lock locked(lock);
  changed.wait_for(locked, stop, time, [] { return false; });
  return !stop.stop_requested();
}

namespace {

template <class Delivered>
bool deliver_all(SourceContext& context, std::span<const Delivered> all, std::stop_token stop) {
  constexpr auto longest = std::chrono::milliseconds(5000);
  auto wait = std::chrono::milliseconds(50);
  while (!context.intake.deliver(context.settings, all).stored) {
    if (!pause(wait, stop)) return false;
    wait = std::min(2 * wait, longest);
  }
  return true;
}

}  // namespace

bool deliver_until_stored(SourceContext& context, std::span<const Message> messages,
                          std::stop_token stop) {
  return deliver_all(context, messages, std::move(stop));
}

bool deliver_until_stored(SourceContext& context, std::span<const Row> rows, std::stop_token stop) {
  return deliver_all(context, rows, std::move(stop));
}

}  // namespace wearwell::monitor
