#include "wearwell/base/stop_scope.h"

#include <utility>

#include "wearwell/base/monitor.h"

namespace wearwell {
namespace {

thread_local std::shared_ptr<const StopSignal> held;
// The same without a destructor, which every access would have to look for.
constinit thread_local const StopSignal* looked_at = nullptr;

}  // namespace

std::shared_ptr<const StopSignal> current_stop_signal() {
  return held;
}

void set_stop_signal(std::shared_ptr<const StopSignal> signal) {
  held = std::move(signal);
  looked_at = held.get();
}

StopScope::StopScope(std::shared_ptr<const StopSignal> signal) : before_(held) {
  set_stop_signal(std::move(signal));
}

StopScope::~StopScope() {
  set_stop_signal(std::move(before_));
}

void check_stop() {
  if (looked_at && looked_at->requested.stop_requested() && !looked_at->ended.load())
    throw Cancelled();
}

}  // namespace wearwell
