#include "wearwell/monitor/monitor_config.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>

#include "wearwell/base/error.h"
#include "wearwell/base/input_errors.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/text_file.h"
#include "wearwell/monitor/foreign_message.h"
#include "wearwell/monitor/http_access.h"
#include "wearwell/monitor/sparkplug_metrics.h"
#include "wearwell/monitor/sparkplug_topic.h"
#include "wearwell/monitor/store.h"

// Longer than others: one file, read from its beginning to its end.
namespace wearwell::monitor {
namespace {

/// The problems of a file's parts, all of them.
class Problems {
 public:
  /// Whether the part has none.
  bool in(const std::function<void()>& part) {
    try {
      part();
      return true;
    } catch (const InputError& error) {
      const std::string text = error.what();
      if (std::find(all_.begin(), all_.end(), text) == all_.end()) all_.push_back(text);
      return false;
    }
  }
  /// A part in a table of its own, with the unknown keys of that. Keys behind the first problem of
  /// a table were never requested, so they are not unknown.
  void in_table(const TomlReader& root, const char* key, const std::function<void()>& part) {
    if (!in(part)) return;
    in([&] {
      if (const auto table = root.table(key)) table->finish();
    });
  }
  bool empty() const { return all_.empty(); }
  void finish() const {
    if (!all_.empty()) throw InputErrors(all_);
  }

 private:
  std::vector<std::string> all_;
};

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

/// Parts of a message beside its fields, which only some forms have.
void check_places(const TomlReader& reading, const SourceSettings& source) {
  const Form form = source.format.form;
  const bool influx = form == Form::influx, opc_ua = form == Form::opc_ua;
  const bool sparkplug = source.kind == SourceKind::sparkplug;
  const auto check = [&](const char* key, const std::string& field) {
    if (!field.starts_with('{') || !field.ends_with('}') || is_place_of(form, field)) return;
    const bool elsewhere = is_place_of(Form::influx, field) || is_place_of(Form::opc_ua, field);
    const bool of_topic = sparkplug && field == timestamp_field;
    if (of_topic || (!influx && !opc_ua && !elsewhere)) return;
    reading.fail(key, fmt::format("'{}' is not in messages of this form{}", field,
                                  influx   ? ", which have {measurement} and {timestamp}"
                                  : opc_ua ? ", which have {publisher}, {writer}, {sequence} and "
                                             "{timestamp}"
                                           : ""));
  };
  const ReadingMapping& mapping = source.mapping;
  check("unit", mapping.unit);
  check("sequence", mapping.sequence);
  check("time", mapping.time);
  check("event", mapping.event);
  for (const ColumnField& column : mapping.columns) {
    if (!column.constant) check("columns", column.field);
  }
  for (const std::string& label : mapping.labels) check("columns", label);
}

/// Keys for topics and properties, which only a source of Sparkplug B may have.
void check_braces(const TomlReader& reading, const SourceSettings& source) {
  const bool sparkplug = source.kind == SourceKind::sparkplug;
  const bool stamped = source.format.form == Form::influx || source.format.form == Form::opc_ua;
  for (const ColumnField& column : source.mapping.columns) {
    if (column.unit_of_message && !sparkplug)
      reading.fail("columns",
                   fmt::format("{}: only metrics of Sparkplug B have an engUnit; give the unit",
                               column.column));
  }
  const ReadingMapping& mapping = source.mapping;
  const auto check = [&](const char* key, const std::string& field) {
    if (stamped && is_place_of(source.format.form, field)) return false;
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
  if (check("sequence", mapping.sequence) && mapping.sequence != timestamp_field)
    reading.fail("sequence", "does not distinguish readings: it is part of the topic");
  check_places(reading, source);
}

/// How messages are written: JSON and CSV by themselves, other forms by name.
void read_format(const TomlReader& table, SourceSettings& source) {
  const auto format = table.choice("format", {"json or csv", "influx", "opc ua"});
  const auto precision = table.choice("precision", {"ns", "us", "ms", "s"});
  if (source.kind == SourceKind::sparkplug) {
    if (format) table.fail("format", "is that of Sparkplug B; remove this");
    return;
  }
  if (format == "opc ua") source.format.form = Form::opc_ua;
  if (format == "influx") {
    source.format.form = Form::influx;
    if (!precision)
      table.fail("precision",
                 "is missing: the unit of the times in the lines, \"ns\", \"us\", \"ms\" or "
                 "\"s\" (InfluxDB and Telegraf use ns)");
    source.format.per_second = *precision == "ns"   ? 1'000'000'000
                               : *precision == "us" ? 1'000'000
                               : *precision == "ms" ? 1'000
                                                    : 1;
  } else if (precision) {
    table.fail("precision", "is for format = \"influx\"");
  }
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
  read_format(table, source);
  const auto own = table.table("reading");
  const TomlReader reading = own ? *own : root.required_table("reading");
  source.mapping = read_mapping(reading, tracker, source.topic.names_unit());
  check_braces(reading, source);
  return source;
}

void read_sources(const TomlReader& root, const prognosis::Tracker& tracker, MonitorConfig& config,
                  Problems& problems) {
  const TomlReader sources = root.required_table("source");
  bool some = false;
  const auto read_one = [&](const std::string& name) {
    some = true;
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
  };
  for (const std::string& name : sources.keys()) {
    if (problems.in([&] { read_one(name); }))
      problems.in([&] { sources.required_table(name).finish(); });
  }
  if (!some) root.fail("source", "has no source: write [source.NAME] with a kind");
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
  in_addr four{};
  in6_addr six{};
  if (inet_pton(AF_INET, host.c_str(), &four) == 1) return ntohl(four.s_addr) >> 24 == 127;
  if (inet_pton(AF_INET6, host.c_str(), &six) == 1) return IN6_IS_ADDR_LOOPBACK(&six) != 0;
  return host == "localhost";
}

/// The first line of a file with a secret.
std::string read_secret(const TomlReader& table, const char* key) {
  const std::filesystem::path file = existing(table, key);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    table.fail(key, fmt::format("{} must be a file with one line", file.string()));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) table.fail(key, fmt::format("{} cannot be read (permissions?)", file.string()));
  constexpr std::size_t longest = 1 << 16;  // bytes
  std::string text(longest, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(longest));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() == longest) table.fail(key, "must be a file with one line");
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  if (text.empty() || text.find_first_of("\r\n") != text.npos)
    table.fail(key, "must be a file with one line");
  return text;
}

std::string read_token(const TomlReader& table, const char* key, const std::string& token) {
  try {
    check_token(token);
  } catch (const InputError& error) {
    table.fail(key, error.what());
  }
  return token;
}

/// [http.tokens.NAME] with a token, or a file with it, and its roles.
void read_tokens(const TomlReader& tokens, HttpSettings& http) {
  for (const std::string& name : tokens.keys()) {
    const TomlReader table = tokens.required_table(name);
    HttpToken each{name, {}, 0};
    const bool in_file = table.has("token_file");
    if (in_file && table.has("token"))
      table.fail("token_file", "is given, and token as well; use one");
    each.token = in_file ? read_token(table, "token_file", read_secret(table, "token_file"))
                         : read_token(table, "token", table.required_text("token"));
    for (const std::string& role : table.texts("roles")) {
      const auto known = role_named(role);
      if (!known)
        table.fail("roles", fmt::format("'{}' is not a role: read, write or operate", role));
      each.roles |= *known;
    }
    if (each.roles == 0) table.fail("roles", "is missing: of read, write, operate");
    const auto same = [&](const HttpToken& other) { return other.token == each.token; };
    if (each.token == http.token || std::any_of(http.tokens.begin(), http.tokens.end(), same))
      table.fail(in_file ? "token_file" : "token",
                 "is another one's token too: who has it would not be known");
    http.tokens.push_back(std::move(each));
  }
}

WebhookSettings read_webhook(const TomlReader& table) {
  WebhookSettings webhook;
  webhook.url = table.required_text("url");
  webhook.tls = webhook.url.starts_with("https://");
  if (!webhook.tls && !webhook.url.starts_with("http://"))
    table.fail("url", "is not a URL like https://HOST/PATH");
  const std::string rest = webhook.url.substr(webhook.tls ? 8 : 7);
  const std::size_t slash = std::min(rest.find_first_of("/?"), rest.size());
  if (rest.substr(0, slash).find('@') != std::string::npos)
    table.fail("url", "has a user; use token_file");
  const HostAndPort address =
      read_address(table, "url", rest.substr(0, slash), webhook.tls ? 443 : 80);
  webhook.host = address.host;
  webhook.port = fmt::format("{}", address.port);
  webhook.target = rest.substr(slash);
  if (!webhook.target.starts_with('/')) webhook.target = "/" + webhook.target;
  const bool plain = std::all_of(webhook.target.begin(), webhook.target.end(),
                                 [](char c) { return c > ' ' && c < '\x7f' && c != '#'; });
  if (!plain) table.fail("url", "has characters that must be percent-encoded");
  if (table.has("token_file")) {
    webhook.token = read_secret(table, "token_file");
    const bool visible = std::all_of(webhook.token.begin(), webhook.token.end(),
                                     [](char c) { return c > ' ' && c < '\x7f'; });
    if (!visible) table.fail("token_file", "has characters that no header can carry");
    if (!webhook.tls && !is_loopback(webhook.host))
      table.fail("token_file", "would be sent unencrypted; use https://");
  }
  if (const auto after = table.quantity("after", "s")) {
    constexpr double longest = 7 * 86400;
    if (!(after->si() >= 0 && after->si() <= longest))
      table.fail("after", "must lie between 0 s and 7 d");
    webhook.lasting = std::chrono::milliseconds(std::llround(1000 * after->si()));
  }
  return webhook;
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
  if (table.has("token")) read_token(table, "token", http.token);
  if (const auto tokens = table.table("tokens")) read_tokens(*tokens, http);
  constexpr std::int64_t most = 10'000;  // each needs a descriptor
  if (const auto all = table.integer("connections", 1, most))
    http.limits.connections = static_cast<std::size_t>(*all);
  if (const auto own = table.integer("connections_of_client", 1, most))
    http.limits.of_client = static_cast<std::size_t>(*own);
  if (table.has("certificate")) http.certificate = existing(table, "certificate");
  if (table.has("key")) http.key = existing(table, "key");
  if (http.certificate.empty() != http.key.empty())
    table.fail(http.key.empty() ? "certificate" : "key", "certificate and key go together");
  if (!is_loopback(http.host) && (!http.needs_token() || http.key.empty()))
    table.fail(
        "listen",
        fmt::format("{} is reachable from other machines: set a token, a certificate and its key",
                    http.host));
  return http;
}

PublishSettings read_publish(const TomlReader& table) {
  PublishSettings publish{read_broker(table, "wearwell-publish"),
                          table.text("prefix").value_or("wearwell")};
  if (publish.prefix.find_first_of("+#") != std::string::npos || publish.prefix.empty())
    table.fail("prefix", "is not a topic");
  return publish;
}

/// What is removed cannot be had back, so a short time is a mistake.
std::optional<double> read_keep(const TomlReader& store) {
  const auto keep = store.quantity("keep", "s");
  if (!keep) return {};
  constexpr double day = 86400, year = 365.25 * day;
  if (!(keep->si() >= day && keep->si() <= 1000 * year))
    store.fail("keep", "must lie between 1 d and 1000 years");
  return keep->si();
}

/// The keys of the file itself, where `finish` would also see those behind a problem.
void refuse_unknown_tables(const TomlReader& root) {
  const std::vector<std::string> known = {"result", "title", "store",   "reading", "source",
                                          "alarm",  "http",  "publish", "webhook", "limits"};
  for (const std::string& key : root.keys()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      root.fail(key, fmt::format("unknown key; did you mean '{}'? (possible: {})",
                                 nearest_name(key, known), fmt::join(known, ", ")));
  }
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
  Problems problems;
  problems.in([&] { config.title = root.text("title").value_or(""); });
  problems.in_table(root, "store", [&] {
    if (const auto store = root.table("store")) {
      config.store = store->text("url").value_or("");
      config.keep_s = read_keep(*store);
    }
    if (config.store.empty()) config.store = "fleet.sqlite";
    if (config.store.find("://") != std::string::npos && !is_postgres(config.store))
      root.required_table("store").fail("url", "is neither a file nor postgresql://...");
  });
  problems.in([&] { read_sources(root, tracker, config, problems); });
  problems.in_table(root, "alarm", [&] { config.alarm = read_alarm(root, tracker); });
  problems.in_table(root, "http", [&] {
    if (const auto http = root.table("http")) config.http = read_http(*http);
    const auto posts = [](const SourceSettings& each) { return each.kind == SourceKind::http; };
    if (!root.has("http") && std::any_of(config.sources.begin(), config.sources.end(), posts))
      root.fail("http", "is missing: a source of kind \"http\" needs a server, [http]");
  });
  problems.in_table(root, "publish", [&] {
    if (const auto publish = root.table("publish")) config.publish = read_publish(*publish);
  });
  problems.in_table(root, "webhook", [&] {
    if (const auto webhook = root.table("webhook")) config.webhook = read_webhook(*webhook);
  });
  problems.in_table(root, "limits", [&] {
    constexpr long long most = 10'000'000;
    if (const auto limits = root.table("limits")) {
      if (const auto units = limits->integer("units", 1, most))
        config.most_units = static_cast<std::size_t>(*units);
    }
  });
  if (problems.empty()) {
    root.finish();
  } else {
    problems.in([&] { refuse_unknown_tables(root); });
  }
  problems.finish();
  return config;
}

}  // namespace wearwell::monitor
