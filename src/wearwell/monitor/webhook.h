#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/notices.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/webhook_settings.h"

namespace wearwell::monitor {

/// What the webhook has done since the start. Any thread may ask.
class WebhookCounts {
 public:
  std::atomic<std::uint64_t> sent = 0, failed = 0, waiting = 0;
  WebhookView view() const { return {sent, failed, waiting}; }
};

/// The alarms that are still to be sent: of each unit at most one, the present one. A change of
/// alarm is due when it has lasted for a while; one that goes back before is never sent. So the
/// queue is never longer than the fleet, and each unit's alarms are sent in their order.
class AlarmQueue {
 public:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    Alarm alarm = Alarm::ok;
    Clock::time_point since = {}, not_before = {};
    std::chrono::milliseconds pause = shortest;
  };
  static constexpr auto shortest = std::chrono::milliseconds(1'000),
                        longest = std::chrono::milliseconds(300'000);

  /// `sent`: the alarm of each unit that was accepted last; ok where none was.
  AlarmQueue(std::map<std::string, SentAlarm> sent, std::chrono::milliseconds lasting)
      : sent_(std::move(sent)), lasting_(lasting) {}

  void see(const std::string& unit, Alarm alarm, Clock::time_point now);
  /// Units whose alarm is due, the one that has waited longest first.
  std::vector<std::string> due(Clock::time_point now) const;
  SentAlarm sent(const std::string& unit) const;
  const Waiting& waiting(const std::string& unit) const { return waiting_.at(unit); }
  std::size_t size() const { return waiting_.size(); }

  /// An attempt begins. Until one succeeds the server may have either alarm, because the answer to
  /// this one may be lost: no alarm of the unit counts as sent, also not the one before.
  void attempted(const std::string& unit) { sent_[unit].unconfirmed = true; }
  void accepted(const std::string& unit, Alarm alarm);
  /// It is due again after a pause, which doubles with each failure.
  void failed(const std::string& unit, Clock::time_point now);

 private:
  std::map<std::string, SentAlarm> sent_;
  std::map<std::string, Waiting> waiting_;
  std::chrono::milliseconds lasting_;
};

/// Sends each unit's alarm to a server, and notes in the store what it has accepted: after a kill it
/// is sent again, at least once.
void send_alarms(const FleetReader& reader, const WebhookSettings& settings, Store& store,
                 Notices& notices, WebhookCounts& counts, std::stop_token stop);

}  // namespace wearwell::monitor
