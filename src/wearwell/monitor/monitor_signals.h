#pragma once

#include <sys/types.h>

#include <array>
#include <csignal>

namespace wearwell::monitor {

/// While it lives, and until MonitorSignals begin, SIGHUP does not end the program: it is noted for
/// them. For the time in which the result is read.
class HangupNote {
 public:
  HangupNote();
  ~HangupNote();
  HangupNote(const HangupNote&) = delete;
  HangupNote& operator=(const HangupNote&) = delete;

 private:
  struct sigaction before_ = {};
};

/// While it lives, SIGINT, SIGTERM and SIGHUP are queued until polled. New threads leave them to it
/// and are not interrupted; existing ones (workers that read the result) note those that reach
/// them. An ignored signal stays ignored. SIGHUP asks for a look at the result; it ends the program
/// only if its terminal is gone.
class MonitorSignals {
 public:
  MonitorSignals();
  ~MonitorSignals();
  MonitorSignals(const MonitorSignals&) = delete;
  MonitorSignals& operator=(const MonitorSignals&) = delete;

  /// Whether the program is asked to end.
  bool ends();
  /// Whether SIGHUP has come since the last call.
  bool reload();

 private:
  void poll();

  static constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, signals.size()> actions_before_ = {};
  sigset_t blocked_, mask_before_;
  bool at_terminal_, ends_ = false, reload_ = false;
};

}  // namespace wearwell::monitor
