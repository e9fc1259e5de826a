#include "wearwell/monitor/monitor_signals.h"

#include <unistd.h>

#include <atomic>
#include <ctime>
#include <optional>

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

struct sigaction noting_action() {
  struct sigaction noting = {};
  noting.sa_handler = note_signal;
  noting.sa_flags = SA_RESTART;
  return noting;
}

/// Whether there was a terminal when the HangupNote began; empty without one.
std::optional<bool> terminal_before;

}  // namespace

HangupNote::HangupNote() {
  hangup_noted = false;
  terminal_before = has_terminal();
  const struct sigaction noting = noting_action();
  sigaction(SIGHUP, nullptr, &before_);
  if (before_.sa_handler != SIG_IGN) sigaction(SIGHUP, &noting, nullptr);
}

HangupNote::~HangupNote() {
  sigaction(SIGHUP, &before_, nullptr);
  terminal_before.reset();
}

MonitorSignals::MonitorSignals() : at_terminal_(terminal_before.value_or(has_terminal())) {
  end_noted = false;
  if (!terminal_before) hangup_noted = false;
  const struct sigaction noting = noting_action();
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
