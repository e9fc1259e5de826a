#include "wearwell/monitor/monitor_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "wearwell/base/error.h"
#include "wearwell/input/text_file.h"
#include "wearwell/monitor/sparkplug_metrics.h"
#include "wearwell/monitor/sparkplug_topic.h"
#include "wearwell/monitor/store.h"

namespace wearwell::monitor {
namespace {

std::filesystem::path folder_of(const TomlReader& reader) {
  return std::filesystem::path(reader.file()).parent_path();
}

std::filesystem::path existing(const TomlReader& table, const char* key) {
  const std::filesystem::path path = folder_of(table) / table.required_text(key);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    table.fail(key, fmt::format("no such file or folder: {}", path.string()));
  return path;
}

struct HostAndPort {
  std::string host;
  int port = 0;
};

/// "host:port", "[::1]:port"; the port may be omitted if there is a default.
HostAndPort read_address(const TomlReader& table, const char* key, std::string_view text,
                         int usual_port) {
  HostAndPort address{"", usual_port};
  std::string_view port;
  bool has_port = false;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == text.npos) table.fail(key, "has an unclosed bracket");
    address.host = text.substr(1, end - 1);
    has_port = text.substr(end + 1).starts_with(':');
    if (has_port) port = text.substr(end + 2);
  } else {
    const std::size_t colon = text.find(':');
    address.host = text.substr(0, colon);
    has_port = colon != text.npos;
    if (has_port) port = text.substr(colon + 1);
  }
  if (has_port) {
    const auto [rest, error] =
        std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (error != std::errc() || rest != port.data() + port.size()) address.port = -1;
  }
  if (address.host.empty() || address.host.find_first_of("/@ ") != std::string::npos ||
      address.port < 1 || address.port > 65535)
    table.fail(key, fmt::format("'{}' is not HOST:PORT", text));
  return address;
}

BrokerSettings read_broker(const TomlReader& table, const std::string& usual_client) {
  BrokerSettings broker;
  const std::string url = table.required_text("broker");
  broker.tls = url.starts_with("mqtts://");
  if (!broker.tls && !url.starts_with("mqtt://"))
    table.fail("broker",
               fmt::format("'{}' is not a URL like mqtt://HOST:PORT or mqtts://HOST:PORT", url));
  const std::string_view rest = std::string_view(url).substr(broker.tls ? 8 : 7);
  const HostAndPort address = read_address(table, "broker", rest, broker.tls ? 8883 : 1883);
  broker.host = address.host;
  broker.port = address.port;
  broker.client = table.text("client").value_or(usual_client);
  if (broker.client.empty() || broker.client.size() > 100)
    table.fail("client", "must be of 1 to 100 bytes");
  broker.user = table.text("user").value_or("");
  if (table.has("password_file")) {
    if (broker.user.empty()) table.fail("password_file", "is a password without a user");
    broker.password = read_text_file(existing(table, "password_file")).text;
    while (!broker.password.empty() && broker.password.back() == '\n') broker.password.pop_back();
  }
  if (table.has("authority")) {
    broker.authority = existing(table, "authority");
    if (!broker.tls) table.fail("authority", "needs a broker at mqtts://");
  }
  broker.version5 = table.choice("protocol", {"5", "3.1.1"}).value_or("5") == "5";
  return broker;
}

/// A level of a topic; all levels by default.
std::string read_level(const TomlReader& table, const char* key, const char* usual) {
  const std::string level = table.text(key).value_or(usual);
  const bool any = level == usual;
  if (level.empty() ? !any : !any && level.find_first_of("/+#{}") != level.npos)
    table.fail(key, fmt::format("'{}' is not a level of a topic", level));
  return level;
}

void read_sparkplug_source(const TomlReader& table, const std::string& name,
                           SourceSettings& source) {
  source.kind = SourceKind::sparkplug;
  source.broker = read_broker(table, "wearwell-" + name);
  source.topic = TopicPattern(fmt::format("spBv1.0/{}/+/{}/#", read_level(table, "group", "+"),
                                          read_level(table, "edge", "+")));
  source.host = read_level(table, "host", "");
  source.births_are_readings =
      table.choice("births", {"values", "readings"}).value_or("values") == "readings";
}

/// Keys for topics and properties, which only a source of Sparkplug B may have.
void check_braces(const TomlReader& reading, const SourceSettings& source) {
  const bool sparkplug = source.kind == SourceKind::sparkplug;
  for (const ColumnField& column : source.mapping.columns) {
    if (column.unit_of_message && !sparkplug)
      reading.fail("columns",
                   fmt::format("{}: only metrics of Sparkplug B have an engUnit; give the unit",
                               column.column));
  }
  const ReadingMapping& mapping = source.mapping;
  const auto check = [&](const char* key, const std::string& field) {
    bool by_topic = field == timestamp_field;
    std::string fault;
    try {
      by_topic = by_topic || names_by_topic(field);
    } catch (const InputError& error) {
      fault = error.what();
    }
    if (by_topic && !sparkplug)
      fault =
          fmt::format("'{}' is for Sparkplug B only; its source may have its own [reading]", field);
    if (!fault.empty() && (sparkplug || by_topic)) reading.fail(key, fault);
    return by_topic;
  };
  if (check("unit", mapping.unit) && mapping.unit.find("{edge}") == mapping.unit.npos &&
      mapping.unit.find("{device}") == mapping.unit.npos)
    reading.fail("unit", "does not identify the machine: use {device} or {edge}");
  if (mapping.time == timestamp_field) {
    check("time", sparkplug ? std::string() : mapping.time);
    if (mapping.format != TimeFormat::unix_ms)
      reading.fail("time_format", "must be \"unix ms\" for {timestamp}");
  }
  for (const std::string& label : mapping.labels) check("columns", label);
}

SourceSettings read_source(const TomlReader& root, const TomlReader& table, const std::string& name,
                           const prognosis::Tracker& tracker) {
  SourceSettings source;
  source.name = name;
  const auto kind = table.choice("kind", {"stdin", "folder", "mqtt", "sparkplug", "http"});
  if (!kind)
    table.fail("kind", "is missing: \"stdin\", \"folder\", \"mqtt\", \"sparkplug\" or \"http\"");
  if (*kind == "folder") {
    source.kind = SourceKind::folder;
    source.folder = existing(table, "folder");
    if (!std::filesystem::is_directory(source.folder))
      table.fail("folder", fmt::format("{} is not a folder", source.folder.string()));
  } else if (*kind == "mqtt") {
    source.kind = SourceKind::mqtt;
    source.broker = read_broker(table, "wearwell-" + name);
    const std::string topic = table.required_text("topic");
    try {
      source.topic = TopicPattern(topic);
    } catch (const InputError& error) {
      table.fail("topic", error.what());
    }
  } else if (*kind == "sparkplug") {
    read_sparkplug_source(table, name, source);
  } else if (*kind == "http") {
    source.kind = SourceKind::http;
  }
  const auto own = table.table("reading");
  const TomlReader reading = own ? *own : root.required_table("reading");
  source.mapping = read_mapping(reading, tracker, source.topic.names_unit());
  check_braces(reading, source);
  return source;
}

void read_sources(const TomlReader& root, const prognosis::Tracker& tracker,
                  MonitorConfig& config) {
  const TomlReader sources = root.required_table("source");
  for (const std::string& name : sources.keys()) {
    const SourceSettings source = read_source(root, sources.required_table(name), name, tracker);
    const auto same = [&](const SourceSettings& each) { return each.kind == source.kind; };
    const bool one_only = source.kind == SourceKind::stdin || source.kind == SourceKind::http;
    if (one_only && std::any_of(config.sources.begin(), config.sources.end(), same))
      sources.fail(name, "is the second source of this kind; only one is possible");
    const bool sequence = !source.mapping.sequence.empty();
    if (!config.sources.empty() && sequence != config.sequence)
      sources.fail(name,
                   "identifies readings by sequence numbers, and another source by times, or vice "
                   "versa; use one");
    config.sequence = sequence;
    config.sources.push_back(source);
  }
  if (config.sources.empty()) root.fail("source", "has no source: write [source.NAME] with a kind");
}

AlarmSettings read_alarm(const TomlReader& root, const prognosis::Tracker& tracker) {
  const TomlReader table = root.required_table("alarm");
  AlarmSettings alarm;
  const prognosis::ReadingColumn& axis = tracker.axis();
  alarm.horizon = required_si(table, "horizon", axis.unit) - axis.unit.offset;
  if (!(alarm.horizon > 0)) table.fail("horizon", "must be above 0");
  const auto share = [&](const char* key, double usual) {
    const auto value = table.quantity(key, "1");
    if (!value) return usual;
    if (!(value->si() > 0 && value->si() < 1))
      table.fail(key, fmt::format("{} must lie between 0 and 1", value->si()));
    return value->si();
  };
  alarm.watch = share("watch", alarm.watch);
  alarm.act = share("act", alarm.act);
  if (!(alarm.watch < alarm.act))
    table.fail("watch", fmt::format("{} must be below act, {}", alarm.watch, alarm.act));
  alarm.hysteresis = share("hysteresis", alarm.hysteresis);
  if (const auto silence = table.quantity("silence", "s")) {
    if (!(silence->si() > 0)) table.fail("silence", "must be above 0");
    alarm.silence = silence->si();
  }
  return alarm;
}

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

HttpSettings read_http(const TomlReader& table) {
  HttpSettings http;
  const std::string listen = table.text("listen").value_or("127.0.0.1:8080");
  const HostAndPort address = read_address(table, "listen", listen, 8080);
  http.host = address.host;
  http.port = address.port;
  http.names = table.texts("names");
  http.events = table.boolean("events").value_or(true);
  http.token = table.text("token").value_or("");
  constexpr std::size_t shortest_token = 16;
  if (table.has("token") && http.token.size() < shortest_token)
    table.fail("token", fmt::format("must be at least {} bytes", shortest_token));
  constexpr std::int64_t most = 10'000;  // each needs a descriptor
  if (const auto all = table.integer("connections", 1, most))
    http.limits.connections = static_cast<std::size_t>(*all);
  if (const auto own = table.integer("connections_of_client", 1, most))
    http.limits.of_client = static_cast<std::size_t>(*own);
  if (table.has("certificate")) http.certificate = existing(table, "certificate");
  if (table.has("key")) http.key = existing(table, "key");
  if (http.certificate.empty() != http.key.empty())
    table.fail(http.key.empty() ? "certificate" : "key", "certificate and key go together");
  if (!is_loopback(http.host) && (http.token.empty() || http.key.empty()))
    table.fail(
        "listen",
        fmt::format("{} is reachable from other machines: set a token, a certificate and its key",
                    http.host));
  return http;
}

}  // namespace

std::filesystem::path read_result_path(const TomlReader& root) {
  root.required_text("result");
  return existing(root, "result");
}

MonitorConfig read_monitor_config(const TomlReader& root, const prognosis::Tracker& tracker) {
  MonitorConfig config;
  config.folder = folder_of(root);
  root.has("result");
  config.title = root.text("title").value_or("");
  if (const auto store = root.table("store")) config.store = store->text("url").value_or("");
  if (config.store.empty()) config.store = "fleet.sqlite";
  if (config.store.find("://") != std::string::npos && !is_postgres(config.store))
    root.required_table("store").fail("url", "is neither a file nor postgresql://...");
  read_sources(root, tracker, config);
  config.alarm = read_alarm(root, tracker);
  if (const auto http = root.table("http")) config.http = read_http(*http);
  const auto posts = [](const SourceSettings& each) { return each.kind == SourceKind::http; };
  if (!config.http && std::any_of(config.sources.begin(), config.sources.end(), posts))
    root.fail("http", "is missing: a source of kind \"http\" needs a server, [http]");
  if (const auto publish = root.table("publish")) {
    config.publish = PublishSettings{read_broker(*publish, "wearwell-publish"),
                                     publish->text("prefix").value_or("wearwell")};
    if (config.publish->prefix.find_first_of("+#") != std::string::npos ||
        config.publish->prefix.empty())
      publish->fail("prefix", "is not a topic");
  }
  constexpr long long most = 10'000'000;
  if (const auto limits = root.table("limits")) {
    if (const auto units = limits->integer("units", 1, most))
      config.most_units = static_cast<std::size_t>(*units);
  }
  root.finish();
  return config;
}

}  // namespace wearwell::monitor
