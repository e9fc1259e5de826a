#include "wearwell/monitor/monitor_signals.h"

#include <unistd.h>

#include <atomic>
#include <ctime>

namespace wearwell::monitor {
namespace {

std::atomic<bool> end_noted = false, hangup_noted = false;
static_assert(std::atomic<bool>::is_always_lock_free);
extern "C" void note_signal(int signal) {
  (signal == SIGHUP ? hangup_noted : end_noted) = true;
}

bool has_terminal() {
  return isatty(STDIN_FILENO) == 1 || isatty(STDOUT_FILENO) == 1 || isatty(STDERR_FILENO) == 1;
}

}  // namespace

MonitorSignals::MonitorSignals() : at_terminal_(has_terminal()) {
  end_noted = hangup_noted = false;
  struct sigaction noting = {};
  noting.sa_handler = note_signal;
  noting.sa_flags = SA_RESTART;
  sigemptyset(&blocked_);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    sigaction(signals[i], nullptr, &actions_before_[i]);
    if (actions_before_[i].sa_handler == SIG_IGN) continue;
    sigaction(signals[i], &noting, nullptr);
    sigaddset(&blocked_, signals[i]);
  }
  pthread_sigmask(SIG_BLOCK, &blocked_, &mask_before_);
}

MonitorSignals::~MonitorSignals() {
  for (std::size_t i = 0; i < signals.size(); ++i)
    sigaction(signals[i], &actions_before_[i], nullptr);
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

void MonitorSignals::poll() {
  constexpr timespec at_once = {0, 0};
  for (int signal = 0; (signal = sigtimedwait(&blocked_, nullptr, &at_once)) > 0;)
    note_signal(signal);
  if (hangup_noted.exchange(false)) {
    if (at_terminal_ && !has_terminal()) {
      ends_ = true;
    } else {
      reload_ = true;
    }
  }
  ends_ = ends_ || end_noted;
}

bool MonitorSignals::ends() {
  poll();
  return ends_;
}

bool MonitorSignals::reload() {
  poll();
  const bool asked = reload_;
  reload_ = false;
  return asked;
}

}  // namespace wearwell::monitor
