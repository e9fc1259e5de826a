#include "wearwell/monitor/publisher.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "wearwell/base/error.h"
#include "wearwell/monitor/fleet_json.h"
#include "wearwell/monitor/mqtt_session.h"
#include "wearwell/monitor/source.h"

namespace wearwell::monitor {
namespace {

/// Runs until the connection is lost; returns the reason.
std::string tell(MqttSession& session, const FleetReader& reader, const PublishSettings& settings,
                 std::stop_token stop) {
  using Clock = std::chrono::steady_clock;
  constexpr auto between = std::chrono::milliseconds(500);
  constexpr int patience_ms = 50;
  std::uint64_t reported = 0;
  Clock::time_point last = {};
  for (bool ends = false; !ends;) {
    ends = stop.stop_requested();  // and publishes the last state
    if (session.wait(patience_ms)) {
      if (std::string problem = session.read(1, 1); !problem.empty()) return problem;
    }
    if (session.accepted() && (ends || Clock::now() - last >= between)) {
      last = Clock::now();
      const std::uint64_t version = reader.version();
      for (const std::string& name : reader.changed_since(reported)) {
        const auto unit = reader.unit(name);
        if (unit)
          session.publish(fmt::format("{}/{}/state", settings.prefix, topic_level(name)),
                          text_of(json_of(unit->view)), true);
      }
      reported = version;
    }
    if (std::string problem = session.write(); !problem.empty()) return problem;
  }
  session.disconnect();
  return {};
}

}  // namespace

void publish_states(const FleetReader& reader, const PublishSettings& settings, Notices& notices,
                    std::stop_token stop) {
  constexpr auto shortest = std::chrono::milliseconds(200),
                 longest = std::chrono::milliseconds(10'000);
  auto wait = shortest;
  try {
    MqttSession session(settings.broker, false);
    while (!stop.stop_requested()) {
      std::string problem = session.connect();
      if (problem.empty()) {
        problem = tell(session, reader, settings, stop);
        if (session.accepted()) wait = shortest;
      }
      if (stop.stop_requested()) return;
      notices.tell("publish", fmt::format("broker {}:{}: {}; trying again", settings.broker.host,
                                          settings.broker.port, problem));
      if (!pause(wait, stop)) return;
      wait = std::min(2 * wait, longest);
    }
  } catch (const std::exception& error) {
    notices.tell("publish", fmt::format("has ended: {}", error.what()));
  }
}

}  // namespace wearwell::monitor
