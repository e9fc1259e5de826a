#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/monitor/mqtt_session.h"
#include "wearwell/monitor/source.h"

namespace wearwell::monitor {
namespace {

constexpr std::size_t most_at_once = 2000, most_bytes_at_once = longest_message;

/// Reads, stores, acknowledges, until the connection is lost; returns the reason. Acknowledges
/// nothing while something read is not stored.
std::string follow(MqttSession& session, SourceContext& context, std::stop_token stop) {
  constexpr int patience_ms = 100;
  bool reported = false;
  while (!stop.stop_requested()) {
    if (session.wait(patience_ms)) {
      std::string problem = session.read(most_at_once, most_bytes_at_once);
      std::vector<Message> messages;
      for (MqttSession::Message& each : session.arrived())
        messages.push_back({std::move(each.topic), std::move(each.payload)});
      session.arrived().clear();
      if (!messages.empty() && !deliver_until_stored(context, messages, stop)) return "stopped";
      if (!problem.empty()) return problem;
    }
    if (std::string problem = session.write(); !problem.empty()) return problem;
    if (session.accepted() && !std::exchange(reported, true))
      context.notices.tell("source." + context.settings.name,
                           fmt::format("follows {} at {}:{}", context.settings.topic.filter(),
                                       context.settings.broker.host, context.settings.broker.port));
  }
  session.disconnect();
  return {};
}

}  // namespace

void stay_connected(SourceContext& context, MqttSession& session, std::stop_token stop,
                    const std::function<std::string()>& follow) {
  const BrokerSettings& broker = context.settings.broker;
  constexpr auto shortest = std::chrono::milliseconds(200),
                 longest = std::chrono::milliseconds(10'000);
  auto wait = shortest;
  while (!stop.stop_requested()) {
    std::string problem = session.connect();
    if (problem.empty()) {
      problem = follow();
      if (session.accepted()) wait = shortest;
    }
    if (stop.stop_requested()) break;
    context.notices.tell(
        "source." + context.settings.name,
        fmt::format("broker {}:{}: {}; trying again", broker.host, broker.port, problem));
    if (!pause(wait, stop)) break;
    wait = std::min(2 * wait, longest);
  }
}

void read_mqtt(SourceContext& context, std::stop_token stop) {
  MqttSession session(context.settings.broker, true);
  session.subscribe(context.settings.topic.filter());
  stay_connected(context, session, stop, [&] { return follow(session, context, stop); });
}

}  // namespace wearwell::monitor
