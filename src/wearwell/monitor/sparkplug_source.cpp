#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "wearwell/base/printable.h"
#include "wearwell/monitor/mqtt_session.h"
#include "wearwell/monitor/source.h"
#include "wearwell/monitor/sparkplug_decoder.h"
#include "wearwell/monitor/time_text.h"

namespace wearwell::monitor {
namespace {

constexpr std::size_t most_at_once = 2000, most_bytes_at_once = longest_message;

std::int64_t clock_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

/// Reads, decodes, stores, until the connection is lost; returns the reason.
std::string follow(MqttSession& session, SparkplugDecoder& decoder, SourceContext& context,
                   std::stop_token stop) {
  constexpr int patience_ms = 100;
  const std::string subject = "source." + context.settings.name;
  decoder.forget();  // messages sent without a connection are lost
  bool reported = false;
  while (!stop.stop_requested()) {
    if (session.wait(patience_ms)) {
      std::string problem = session.read(most_at_once, most_bytes_at_once);
      std::vector<Row> rows;
      for (const MqttSession::Message& each : session.arrived())
        decoder.read(each.topic, each.payload, rows);
      session.arrived().clear();
      if (!rows.empty() && !deliver_until_stored(context, rows, stop)) return "stopped";
      if (!problem.empty()) return problem;
    }
    for (const std::string& topic : decoder.rebirths(clock_ms())) {
      session.publish(topic, rebirth_request(unix_ms_now()), false, 0);
      context.notices.tell(subject, "asks for birth certificates: " + printable(topic));
    }
    if (std::string problem = session.write(); !problem.empty()) return problem;
    if (session.accepted() && !std::exchange(reported, true))
      context.notices.tell(subject,
                           fmt::format("follows {} at {}:{}", context.settings.topic.filter(),
                                       context.settings.broker.host, context.settings.broker.port));
  }
  session.disconnect();
  return {};
}

}  // namespace

void read_sparkplug_source(SourceContext& context, std::stop_token stop) {
  const SourceSettings& settings = context.settings;
  MqttSession session(settings.broker, false);
  session.subscribe(settings.topic.filter());
  if (!settings.host.empty()) session.tell_presence("spBv1.0/STATE/" + settings.host);
  SparkplugDecoder decoder(settings);
  stay_connected(context, session, stop, [&] { return follow(session, decoder, context, stop); });
}

}  // namespace wearwell::monitor
