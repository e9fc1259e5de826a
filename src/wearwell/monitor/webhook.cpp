#include "wearwell/monitor/webhook.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "wearwell/base/printable.h"
#include "wearwell/fleet/http_post.h"
#include "wearwell/monitor/fleet_json.h"
#include "wearwell/monitor/source.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {

void AlarmQueue::see(const std::string& unit, Alarm alarm, Clock::time_point now) {
  if (sent(unit) == SentAlarm{alarm, false}) {
    waiting_.erase(unit);
    return;
  }
  const auto [at, fresh] = waiting_.try_emplace(unit);
  if (!fresh && at->second.alarm == alarm) return;
  // Another alarm is another message, but a server that does not answer is still the same.
  const Waiting before = at->second;
  at->second = {alarm, now, before.not_before, before.pause};
}

std::vector<std::string> AlarmQueue::due(Clock::time_point now) const {
  std::vector<std::pair<Clock::time_point, std::string>> found;
  for (const auto& [unit, each] : waiting_) {
    if (now - each.since >= lasting_ && now >= each.not_before)
      found.emplace_back(each.since, unit);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> units;
  for (auto& [since, unit] : found) units.push_back(std::move(unit));
  return units;
}

SentAlarm AlarmQueue::sent(const std::string& unit) const {
  const auto found = sent_.find(unit);
  return found == sent_.end() ? SentAlarm() : found->second;
}

void AlarmQueue::accepted(const std::string& unit, Alarm alarm) {
  sent_[unit] = {alarm, false};
  const auto at = waiting_.find(unit);
  if (at != waiting_.end() && at->second.alarm == alarm) waiting_.erase(at);
}

void AlarmQueue::failed(const std::string& unit, Clock::time_point now) {
  Waiting& each = waiting_.at(unit);
  each.not_before = now + each.pause;
  each.pause = std::min(2 * each.pause, longest);
}

namespace {

/// The problem; empty if the server has accepted it.
std::string post(const WebhookSettings& settings, const std::string& body,
                 const std::stop_token& stop) {
  struct Stopped {};
  fleet::HttpRequest request;
  request.target = settings.target;
  request.fields = {{"Content-Type", "application/json"}, {"User-Agent", "wearwell"}};
  if (!settings.token.empty())
    request.fields.emplace_back("Authorization", "Bearer " + settings.token);
  request.body = body;
  request.seconds = 30;
  request.wait = [&] {
    if (stop.stop_requested()) throw Stopped();
  };
  int status = 0;
  std::size_t bytes = 0;
  constexpr std::size_t most = 1 << 20;
  try {
    fleet::http_post({settings.host, settings.port, settings.tls}, request,
                     [&](int each, std::string_view piece) {
                       status = each;
                       bytes += piece.size();
                       if (bytes > most) throw fleet::HttpBroken("the answer is too long");
                     });
  } catch (const Stopped&) {
    return "stopped";
  } catch (const fleet::HttpBroken& error) {
    // What follows the status does not matter.
    if (status < 200 || status >= 300) return error.what();
  }
  if (status >= 200 && status < 300) return {};
  return status == 0 ? std::string("no answer") : fmt::format("it answers with status {}", status);
}

std::string message_of_alarm(const FleetView& fleet, const UnitView& unit, Alarm before) {
  nlohmann::ordered_json json = {{"title", fleet.title},      {"unit", unit.unit},
                                 {"alarm", name(unit.alarm)}, {"before", name(before)},
                                 {"alarm_ms", unit.alarm_ms}, {"sent_ms", unix_ms_now()},
                                 {"axis", fleet.axis},        {"axis_unit", fleet.axis_unit},
                                 {"limited", fleet.limited},  {"level_unit", fleet.level_unit},
                                 {"horizon", fleet.horizon}};
  json["state"] = json_of(unit);
  return text_of(json);
}

/// What the store is to know of sent alarms, until it knows it.
class SentNotes {
 public:
  SentNotes(Store& store, Notices& notices) : store_(store), notices_(notices) {}

  void add(const std::string& unit, const SentAlarm& sent) { waiting_[unit] = sent; }
  /// A store that does not respond is tried again; the webhook does not wait for it.
  void write() {
    try {
      while (!waiting_.empty()) {
        const auto first = waiting_.begin();
        store_.note_sent(first->first, first->second, unix_ms_now());
        waiting_.erase(first);
      }
    } catch (const StoreError& error) {
      notices_.tell("store", error.what());
    }
  }

 private:
  Store& store_;
  Notices& notices_;
  std::map<std::string, SentAlarm> waiting_;
};

}  // namespace

void send_alarms(const FleetReader& reader, const WebhookSettings& settings, Store& store,
                 Notices& notices, WebhookCounts& counts, std::stop_token stop) {
  constexpr auto between = std::chrono::milliseconds(200);
  std::optional<AlarmQueue> queue;
  SentNotes notes(store, notices);
  std::uint64_t seen = 0;
  const auto trouble = [&](const std::string& problem) {
    notices.tell("webhook", fmt::format("{}: {}; trying again", settings.url, problem));
  };
  while (pause(between, stop)) {
    try {
      if (!queue) queue.emplace(store.sent_alarms(), settings.lasting);
      notes.write();
      const std::uint64_t version = reader.version();
      for (const std::string& name : reader.changed_since(seen)) {
        if (const auto unit = reader.view(name))
          queue->see(name, unit->alarm, AlarmQueue::Clock::now());
      }
      seen = version;
      counts.waiting = queue->size();
      for (const std::string& name : queue->due(AlarmQueue::Clock::now())) {
        const auto unit = reader.view(name);
        // If it has changed just now, it must last first.
        if (!unit || unit->alarm != queue->waiting(name).alarm) continue;
        const SentAlarm before = queue->sent(name);
        queue->attempted(name);
        if (!before.unconfirmed) {  // before the first attempt, for a start after a kill
          notes.add(name, queue->sent(name));
          notes.write();
        }
        const std::string problem =
            post(settings, message_of_alarm(reader.fleet(), *unit, before.alarm), stop);
        if (stop.stop_requested() && !problem.empty()) return;
        if (!problem.empty()) {
          ++counts.failed;
          queue->failed(name, AlarmQueue::Clock::now());
          trouble(problem);
          break;  // look at what has changed meanwhile
        }
        ++counts.sent;
        queue->accepted(name, unit->alarm);
        counts.waiting = queue->size();
        notes.add(name, queue->sent(name));
        notes.write();
      }
    } catch (const StoreError& error) {
      notices.tell("store", error.what());
    } catch (const std::exception& error) {
      trouble(error.what());
    }
  }
}

}  // namespace wearwell::monitor
