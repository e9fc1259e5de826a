#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/monitor/alarm.h"
#include "wearwell/monitor/http_settings.h"
#include "wearwell/monitor/reading_mapping.h"
#include "wearwell/monitor/topic_pattern.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// A broker of MQTT and who speaks to it.
struct BrokerSettings {
  std::string host;
  int port = 1883;
  bool tls = false;
  std::string client;  ///< the name under which the broker keeps what was not acknowledged
  std::string user = {}, password = {};
  std::filesystem::path authority =
      {};                ///< PEM of who vouches for the broker; empty: those of the system
  bool version5 = true;  ///< else MQTT 3.1.1
};

enum class SourceKind { stdin, folder, mqtt, sparkplug, http };

/// Where readings come from: [source.NAME].
struct SourceSettings {
  std::string name;
  SourceKind kind = SourceKind::stdin;
  ReadingMapping mapping;
  std::filesystem::path folder = {};
  BrokerSettings broker = {};
  TopicPattern topic = {};
  std::string host =
      {};  ///< of Sparkplug B: as whom it tells edge nodes that it is there; "": it does not
  bool births_are_readings =
      false;  ///< of Sparkplug B: what birth certificates say is measured then
};

/// Where states are told: [publish].
struct PublishSettings {
  BrokerSettings broker;
  std::string prefix;  ///< PREFIX/UNIT/state
};

/// What `wearwell monitor` is told in its file (docs/reference/monitor.md).
struct MonitorConfig {
  std::string title;
  std::filesystem::path folder;  ///< of the file; paths in it are relative to this
  std::string store;             ///< file or URL
  std::vector<SourceSettings> sources;
  AlarmSettings alarm;
  std::optional<HttpSettings> http;
  std::optional<PublishSettings> publish;
  std::size_t most_units = 100'000;  ///< a reading of one more is refused
  bool sequence = false;             ///< sequence numbers tell readings apart, else times
};

/// The folder of results that the file names. Throws InputError.
std::filesystem::path read_result_path(const TomlReader& root);

/// All else. Throws InputError with file, place and key: unknown keys with the nearest, what is missing, contradicts itself or can be
/// read in two ways.
MonitorConfig read_monitor_config(const TomlReader& root, const prognosis::Tracker& tracker);

}  // namespace wearwell::monitor
