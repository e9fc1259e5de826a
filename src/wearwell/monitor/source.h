#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "wearwell/monitor/intake.h"
#include "wearwell/monitor/monitor_config.h"

namespace wearwell::monitor {

/// The context of a source: its inbox and its notices.
struct SourceContext {
  const SourceSettings& settings;
  Intake& intake;
  Store& store;
  Notices& notices;
  bool once = false;  ///< ends after reading all existing input
};

/// Delivers until it is stored, with growing pauses while the store is not available. False if it
/// was asked to stop before.
bool deliver_until_stored(SourceContext& context, std::span<const Message> messages,
                          std::stop_token stop);
bool deliver_until_stored(SourceContext& context, std::span<const Row> rows, std::stop_token stop);

/// Waits; false if it was asked to stop.
bool pause(std::chrono::milliseconds time, std::stop_token stop);

/// Lines of JSON or CSV from a descriptor, until its end.
void read_stream(SourceContext& context, int descriptor, std::stop_token stop);

/// Growing files of lines in a folder: .jsonl, .ndjson, .json, .csv. A line counts when it is
/// complete; with `once`, also at the end of the file.
void read_folder(SourceContext& context, std::stop_token stop);

/// Messages of a broker. A message is acknowledged after it is stored.
void read_mqtt(SourceContext& context, std::stop_token stop);

/// Messages of Sparkplug B of a broker.
void read_sparkplug_source(SourceContext& context, std::stop_token stop);

class MqttSession;
/// Connects, calls `follow` until the connection is lost, and again after a pause. `follow` returns
/// the reason.
void stay_connected(SourceContext& context, MqttSession& session, std::stop_token stop,
                    const std::function<std::string()>& follow);

}  // namespace wearwell::monitor
