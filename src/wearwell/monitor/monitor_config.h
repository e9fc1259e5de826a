#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/http/settings.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/monitor/alarm.h"
#include "wearwell/monitor/reading_mapping.h"
#include "wearwell/monitor/topic_pattern.h"
#include "wearwell/monitor/webhook_settings.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

/// A broker of MQTT and the client's identity.
struct BrokerSettings {
  std::string host;
  int port = 1883;
  bool tls = false;
  std::string client;  ///< the client's name, under which the broker keeps unacknowledged messages
  std::string user = {}, password = {};
  std::filesystem::path authority =
      /// PEM of the certificate authority of the broker; empty: those of the system
      {};
  bool version5 = true;  ///< else MQTT 3.1.1
};

enum class SourceKind { stdin, folder, mqtt, sparkplug, http };

/// A source of readings: [source.NAME].
struct SourceSettings {
  std::string name;
  SourceKind kind = SourceKind::stdin;
  ReadingMapping mapping;
  std::filesystem::path folder = {};
  BrokerSettings broker = {};
  TopicPattern topic = {};
  MessageFormat format = {};  ///< not of Sparkplug B
  std::string host = {};      ///< of Sparkplug B: the host ID for its STATE; "": none
  bool births_are_readings =
      false;  ///< of Sparkplug B: whether birth certificates count as measurements
};

/// Where states are published: [publish].
struct PublishSettings {
  BrokerSettings broker;
  std::string prefix;  ///< PREFIX/UNIT/state
};

/// The configuration file of `wearwell monitor` (docs/reference/monitor.md).
struct MonitorConfig {
  std::string title;
  std::filesystem::path folder;  ///< folder of the file, to which paths in it are relative
  std::string store;             ///< file or URL
  /// How long readings of parts out of service and earlier forecasts are kept, s; empty: for ever.
  std::optional<double> keep_s = {};
  std::vector<SourceSettings> sources;
  AlarmSettings alarm;
  std::optional<HttpSettings> http;
  std::optional<PublishSettings> publish;
  std::optional<WebhookSettings> webhook;
  std::size_t most_units = 100'000;  ///< further units are refused
  bool sequence = false;             ///< sequence numbers identify readings, else times
};

inline constexpr const char* default_store = "fleet.sqlite";

/// Throws InputError: unreadable, not TOML, or empty, with what it needs.
TomlReader read_config_file(const std::filesystem::path& file);

/// The store alone, of a file whose rest may be wrong. Throws InputError.
std::string read_store(const TomlReader& root);

/// The folder of results named in the file. Throws InputErrors with all of the file that is wrong,
/// as far as no result is needed to see it.
std::filesystem::path read_result_path(const TomlReader& root);

/// Throws InputErrors with a problem of the result, and all of the file that needs no result.
[[noreturn]] void refuse_result(const TomlReader& root, const std::string& why);

/// Everything else. Throws InputErrors with file, place and key: unknown keys with the nearest name,
/// missing, contradictory or ambiguous values; all of them, in the order of the file.
MonitorConfig read_monitor_config(const TomlReader& root, const prognosis::Tracker& tracker);

}  // namespace wearwell::monitor
