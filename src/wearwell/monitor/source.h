#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "wearwell/monitor/intake.h"
#include "wearwell/monitor/monitor_config.h"

namespace wearwell::monitor {

/// What a source hands its messages to, and tells.
struct SourceContext {
  const SourceSettings& settings;
  Intake& intake;
  Store& store;
  Notices& notices;
  bool once = false;  ///< ends when all that is there has been read
};

/// Delivers until it is stored, with growing pauses where the store cannot take it now. False when it was asked to stop before that.
bool deliver_until_stored(SourceContext& context, std::span<const Message> messages,
                          std::stop_token stop);
bool deliver_until_stored(SourceContext& context, std::span<const Row> rows, std::stop_token stop);

/// Waits; false when it was asked to stop.
bool pause(std::chrono::milliseconds time, std::stop_token stop);

/// Lines of JSON or CSV from a descriptor, until its end.
void read_stream(SourceContext& context, int descriptor, std::stop_token stop);

/// Files of lines in a folder that come and grow: .jsonl, .ndjson, .json, .csv. A line counts when it has ended; with `once`, also when the file
/// has.
void read_folder(SourceContext& context, std::stop_token stop);

/// Messages of a broker. It is told that a message has arrived when that is stored.
void read_mqtt(SourceContext& context, std::stop_token stop);

/// Messages of Sparkplug B of a broker.
void read_sparkplug_source(SourceContext& context, std::stop_token stop);

class MqttSession;
/// Connects, calls `follow` until that is lost, and again after a pause. `follow` returns why.
void stay_connected(SourceContext& context, MqttSession& session, std::stop_token stop,
                    const std::function<std::string()>& follow);

}  // namespace wearwell::monitor
