#include "wearwell/monitor/monitor_config.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/text_file.h"
#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/foreign_message.h"
#include "wearwell/monitor/http_access.h"
#include "wearwell/monitor/sparkplug_metrics.h"
#include "wearwell/monitor/sparkplug_topic.h"
#include "wearwell/monitor/store.h"

// Longer than others: one file, read from its beginning to its end.
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
  const auto read_url = [&] {
    const std::string url = table.required_text("broker");
    broker.tls = url.starts_with("mqtts://");
    if (!broker.tls && !url.starts_with("mqtt://"))
      table.fail("broker",
                 fmt::format("'{}' is not a URL like mqtt://HOST:PORT or mqtts://HOST:PORT", url));
    const std::string_view rest = std::string_view(url).substr(broker.tls ? 8 : 7);
    const HostAndPort address = read_address(table, "broker", rest, broker.tls ? 8883 : 1883);
    broker.host = address.host;
    broker.port = address.port;
  };
  Problems problems;
  const bool has_url = problems.in(read_url, "broker = \"mqtts://broker.example:8883\"");
  problems.in(
      [&] {
        broker.client = table.text("client").value_or(usual_client);
        if (broker.client.empty() || broker.client.size() > 100)
          table.fail("client", "must be of 1 to 100 bytes");
      },
      fmt::format("client = \"{}\"", usual_client));
  problems.in([&] { broker.user = table.text("user").value_or(""); }, "user = \"wearwell\"");
  problems.in([&] {
    if (!table.has("password_file")) return;
    if (broker.user.empty())
      table.fail("password_file", "is a password without a user; add user = \"...\"");
    broker.password = read_text_file(existing(table, "password_file")).text;
    while (!broker.password.empty() && broker.password.back() == '\n') broker.password.pop_back();
  });
  problems.in([&] {
    if (!table.has("authority")) return;
    broker.authority = existing(table, "authority");
    if (has_url && !broker.tls) table.fail("authority", "needs a broker at mqtts://");
  });
  problems.in(
      [&] {
        broker.version5 = table.choice("protocol", {"5", "3.1.1"}).value_or("5") == "5";
      },
      "protocol = \"5\"");
  problems.finish();
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
  Problems problems;
  problems.in([&] { source.broker = read_broker(table, "wearwell-" + name); });
  std::string group, edge;
  problems.in([&] { group = read_level(table, "group", "+"); }, "group = \"Plant 1\"");
  problems.in([&] { edge = read_level(table, "edge", "+"); }, "edge = \"Line 2\"");
  problems.in([&] { source.host = read_level(table, "host", ""); }, "host = \"wearwell\"");
  problems.in(
      [&] {
        source.births_are_readings =
            table.choice("births", {"values", "readings"}).value_or("values") == "readings";
      },
      "births = \"values\"");
  problems.finish();
  source.topic = TopicPattern(fmt::format("spBv1.0/{}/+/{}/#", group, edge));
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

TopicPattern read_topic(const TomlReader& table) {
  const std::string topic = table.required_text("topic");
  try {
    return TopicPattern(topic);
  } catch (const InputError& error) {
    table.fail("topic", error.what());
  }
}

/// Without [reading] nothing of it can be checked: its whole is the example.
[[noreturn]] void fail_without_reading(const TomlReader& root, const prognosis::Tracker& tracker) {
  std::string columns;
  for (const prognosis::ReadingColumn& each : tracker.columns())
    columns += "\n    " + example_line(each);
  for (const std::string& each : tracker.labels()) columns += "\n    " + example_line(each);
  root.fail(
      "reading",
      fmt::format("is missing: the fields of a message; for example:\n    [reading]\n    unit "
                  "= \"{}\"\n    time = \"t\"\n    time_format = \"iso 8601\"\n    "
                  "[reading.columns]{}",
                  tracker.noun().empty() ? "unit" : tracker.noun(), columns));
}

SourceSettings read_source(const TomlReader& root, const TomlReader& table, const std::string& name,
                           const prognosis::Tracker& tracker) {
  SourceSettings source;
  source.name = name;
  const auto kind = table.choice("kind", {"stdin", "folder", "mqtt", "sparkplug", "http"});
  if (!kind)
    table.fail("kind",
               "is missing: \"stdin\", \"folder\", \"mqtt\", \"sparkplug\" or \"http\"; for "
               "example: kind = \"stdin\"");
  Problems problems;
  if (*kind == "folder") {
    source.kind = SourceKind::folder;
    problems.in(
        [&] {
          source.folder = existing(table, "folder");
          if (!std::filesystem::is_directory(source.folder))
            table.fail("folder", fmt::format("{} is not a folder", source.folder.string()));
        },
        "folder = \"incoming\", after mkdir incoming beside this file");
  } else if (*kind == "mqtt") {
    source.kind = SourceKind::mqtt;
    problems.in([&] { source.broker = read_broker(table, "wearwell-" + name); });
    problems.in([&] { source.topic = read_topic(table); }, "topic = \"plant/{unit}/wear\"");
  } else if (*kind == "sparkplug") {
    source.kind = SourceKind::sparkplug;
    problems.in([&] { read_sparkplug_source(table, name, source); });
  } else if (*kind == "http") {
    source.kind = SourceKind::http;
  }
  problems.in([&] { read_format(table, source); }, "format = \"influx\" with precision = \"ns\"");
  problems.in([&] {
    const auto own = table.table("reading");
    if (!own && !root.has("reading")) fail_without_reading(root, tracker);
    const TomlReader reading = own ? *own : root.required_table("reading");
    source.mapping = read_mapping(reading, tracker, source.topic.names_unit());
    check_braces(reading, source);
  });
  problems.finish();
  return source;
}

void read_sources(const TomlReader& root, const prognosis::Tracker& tracker, MonitorConfig& config,
                  Problems& problems) {
  if (!root.has("source"))
    root.fail("source",
              "is missing: where readings come from; for example:\n    [source.line]\n    kind = "
              "\"stdin\"");
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
  if (!some)
    root.fail("source", "has no source; for example:\n    [source.line]\n    kind = \"stdin\"");
}

AlarmSettings read_alarm(const TomlReader& root, const prognosis::Tracker& tracker) {
  const prognosis::ReadingColumn& axis = tracker.axis();
  const std::string horizon = fmt::format("horizon = \"500 {}\"", axis.unit.text);
  if (!root.has("alarm"))
    root.fail("alarm", fmt::format("is missing: how far ahead the risk looks; for example:\n    "
                                   "[alarm]\n    {}",
                                   horizon));
  const TomlReader table = root.required_table("alarm");
  AlarmSettings alarm;
  Problems problems;
  problems.in(
      [&] {
        alarm.horizon = required_si(table, "horizon", axis.unit) - axis.unit.offset;
        if (!(alarm.horizon > 0)) table.fail("horizon", "must be above 0");
      },
      horizon);
  const auto share = [&](const char* key, double& into) {
    const std::string example = fmt::format("{} = {}", key, into);
    return problems.in(
        [&] {
          const auto value = table.quantity(key, "1");
          if (!value) return;
          if (!(value->si() > 0 && value->si() < 1))
            table.fail(key, fmt::format("{} must lie between 0 and 1", value->si()));
          into = value->si();
        },
        example);
  };
  const bool watch = share("watch", alarm.watch), act = share("act", alarm.act);
  if (watch && act) {
    problems.in(
        [&] {
          if (!(alarm.watch < alarm.act))
            table.fail("watch", fmt::format("{} must be below act, {}", alarm.watch, alarm.act));
        },
        "watch = 0.05 with act = 0.2");
  }
  share("hysteresis", alarm.hysteresis);
  problems.in(
      [&] {
        const auto silence = table.quantity("silence", "s");
        if (!silence) return;
        if (!(silence->si() > 0)) table.fail("silence", "must be above 0");
        alarm.silence = silence->si();
      },
      "silence = \"2 d\"");
  problems.in([&] { table.finish(); });
  problems.finish();
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

/// A token in the configuration, or in a file.
std::string read_token_or_file(const TomlReader& table) {
  const bool in_file = table.has("token_file"), here = table.has("token");
  if (in_file && here) table.fail("token_file", "is given, and token as well; use one");
  if (!in_file && !here)
    table.fail("token",
               "is missing, and so is token_file; for example: token_file = \"NAME.token\", "
               "after openssl rand -hex 16 > NAME.token");
  return in_file ? read_token(table, "token_file", read_secret(table, "token_file"))
                 : read_token(table, "token", table.required_text("token"));
}

/// [http.tokens.NAME] with a token, or a file with it, and its roles.
void read_tokens(const TomlReader& tokens, HttpSettings& http) {
  Problems problems;
  const auto read_one = [&](const std::string& name) {
    const TomlReader table = tokens.required_table(name);
    HttpToken each{name, {}, 0};
    const bool in_file = table.has("token_file");
    Problems own;
    own.in([&] { each.token = read_token_or_file(table); });
    own.in(
        [&] {
          for (const std::string& role : table.texts("roles")) {
            const auto known = role_named(role);
            if (!known)
              table.fail("roles", fmt::format("'{}' is not a role: read, write or operate", role));
            each.roles |= *known;
          }
          if (each.roles == 0) table.fail("roles", "is missing: of read, write, operate");
        },
        "roles = [\"read\"]");
    own.finish();
    const auto same = [&](const HttpToken& other) { return other.token == each.token; };
    if (each.token == http.token || std::any_of(http.tokens.begin(), http.tokens.end(), same))
      table.fail(in_file ? "token_file" : "token",
                 "is another one's token too: who has it would not be known");
    http.tokens.push_back(std::move(each));
  };
  for (const std::string& name : tokens.keys()) problems.in([&] { read_one(name); });
  problems.finish();
}

void read_webhook_url(const TomlReader& table, WebhookSettings& webhook) {
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
}

void read_webhook_token(const TomlReader& table, bool has_url, WebhookSettings& webhook) {
  if (!table.has("token_file")) return;
  webhook.token = read_secret(table, "token_file");
  const bool visible = std::all_of(webhook.token.begin(), webhook.token.end(),
                                   [](char c) { return c > ' ' && c < '\x7f'; });
  if (!visible) table.fail("token_file", "has characters that no header can carry");
  if (has_url && !webhook.tls && !is_loopback(webhook.host))
    table.fail("token_file", "would be sent unencrypted; use https://");
}

WebhookSettings read_webhook(const TomlReader& table) {
  WebhookSettings webhook;
  Problems problems;
  const bool has_url = problems.in([&] { read_webhook_url(table, webhook); },
                                   "url = \"https://alarms.example/wear\"");
  problems.in([&] { read_webhook_token(table, has_url, webhook); });
  problems.in(
      [&] {
        const auto after = table.quantity("after", "s");
        if (!after) return;
        constexpr double longest = 7 * 86400;
        if (!(after->si() >= 0 && after->si() <= longest))
          table.fail("after", "must lie between 0 s and 7 d");
        webhook.lasting = std::chrono::milliseconds(std::llround(1000 * after->si()));
      },
      "after = \"1 min\"");
  problems.in([&] { table.finish(); });
  problems.finish();
  return webhook;
}

void read_http_limits(const TomlReader& table, HttpSettings& http, Problems& problems) {
  constexpr std::int64_t most = 10'000;  // each needs a descriptor
  const auto limit = [&](const char* key, std::size_t& into) {
    problems.in(
        [&] {
          if (const auto value = table.integer(key, 1, most))
            into = static_cast<std::size_t>(*value);
        },
        fmt::format("{} = {}", key, into));
  };
  limit("connections", http.limits.connections);
  limit("connections_of_client", http.limits.of_client);
  limit("streams_of_client", http.limits.streams_of_client);
}

HttpSettings read_http(const TomlReader& table) {
  HttpSettings http;
  Problems problems;
  const bool has_address = problems.in(
      [&] {
        const std::string listen = table.text("listen").value_or("127.0.0.1:8080");
        const HostAndPort address = read_address(table, "listen", listen, 8080);
        http.host = address.host;
        http.port = address.port;
      },
      "listen = \"127.0.0.1:8080\"");
  problems.in([&] { http.names = table.texts("names"); }, "names = [\"fleet.example\"]");
  problems.in([&] { http.events = table.boolean("events").value_or(true); }, "events = true");
  const std::size_t before_tokens = problems.count();
  problems.in([&] {
    if (table.has("token") || table.has("token_file")) http.token = read_token_or_file(table);
  });
  problems.in([&] {
    if (const auto tokens = table.table("tokens")) read_tokens(*tokens, http);
  });
  read_http_limits(table, http, problems);
  const std::size_t before_files = problems.count();
  const bool tokens_are_right = before_tokens == before_files;
  for (const auto& [key, file] : {std::pair("certificate", &http.certificate), {"key", &http.key}})
    problems.in([&, to = file, name = key] {
      if (table.has(name)) *to = existing(table, name);
    });
  if (problems.count() == before_files) {
    problems.in([&] {
      if (http.certificate.empty() != http.key.empty())
        table.fail(http.key.empty() ? "certificate" : "key",
                   "certificate and key go together; for example: certificate = \"cert.pem\" with "
                   "key = \"key.pem\"");
    });
  }
  const bool open = tokens_are_right && !http.needs_token();
  if (has_address && !is_loopback(http.host) && (open || !table.has("key"))) {
    problems.in(
        [&] {
          table.fail("listen", fmt::format("{} is reachable from other machines: set a token, a "
                                           "certificate and its key",
                                           http.host));
        },
        fmt::format("{}certificate = \"cert.pem\" and key = \"key.pem\"",
                    open ? "token_file = \"fleet.token\", " : ""));
  }
  problems.in([&] { table.finish(); });
  problems.finish();
  return http;
}

PublishSettings read_publish(const TomlReader& table) {
  PublishSettings publish;
  Problems problems;
  problems.in([&] { publish.broker = read_broker(table, "wearwell-publish"); });
  problems.in(
      [&] {
        publish.prefix = table.text("prefix").value_or("wearwell");
        if (publish.prefix.find_first_of("+#") != std::string::npos || publish.prefix.empty())
          table.fail("prefix", "is not a topic");
      },
      "prefix = \"wearwell\"");
  problems.in([&] { table.finish(); });
  problems.finish();
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

/// What can be read without the population of the result.
void read_own_tables(const TomlReader& root, MonitorConfig& config, Problems& problems) {
  problems.in([&] { config.title = root.text("title").value_or(""); },
              "title = \"Pumps of hall 2\"");
  problems.in_table(root, "store", [&] {
    config.store = "fleet.sqlite";
    const auto store = root.table("store");
    if (!store) return;
    problems.in(
        [&] {
          const std::string url = store->text("url").value_or("");
          if (url.find("://") != std::string::npos && !is_postgres(url))
            store->fail("url", "is neither a file nor postgresql://...");
          if (!url.empty()) config.store = url;
        },
        "url = \"fleet.sqlite\"");
    problems.in([&] { config.keep_s = read_keep(*store); }, "keep = \"5 years\"");
  });
  problems.in_table(root, "http", [&] {
    if (const auto http = root.table("http")) config.http = read_http(*http);
  });
  problems.in_table(root, "publish", [&] {
    if (const auto publish = root.table("publish")) config.publish = read_publish(*publish);
  });
  problems.in_table(root, "webhook", [&] {
    if (const auto webhook = root.table("webhook")) config.webhook = read_webhook(*webhook);
  });
  problems.in_table(root, "limits", [&] {
    constexpr long long most = 10'000'000;
    const auto limits = root.table("limits");
    if (!limits) return;
    problems.in(
        [&] {
          if (const auto units = limits->integer("units", 1, most))
            config.most_units = static_cast<std::size_t>(*units);
        },
        "units = 1000");
  });
}

}  // namespace

std::filesystem::path read_result_path(const TomlReader& root) {
  std::filesystem::path result;
  Problems problems;
  const bool found = problems.in(
      [&] {
        if (!root.has("result"))
          root.fail("result", "is missing: the folder that wearwell fit has written");
        result = existing(root, "result");
      },
      "result = \"study-results\"");
  if (found) return result;
  MonitorConfig rest;
  read_own_tables(root, rest, problems);
  for (const char* key : {"reading", "source", "alarm"}) {
    problems.in([&] {
      if (!root.has(key))
        root.fail(key, "is missing; wearwell new monitor NAME --from RESULT writes it");
    });
  }
  problems.in([&] { refuse_unknown_tables(root); });
  problems.finish();
  return result;
}

MonitorConfig read_monitor_config(const TomlReader& root, const prognosis::Tracker& tracker) {
  MonitorConfig config;
  config.folder = folder_of(root);
  root.has("result");
  Problems problems;
  read_own_tables(root, config, problems);
  problems.in([&] { read_sources(root, tracker, config, problems); });
  problems.in([&] {
    const auto posts = [](const SourceSettings& each) { return each.kind == SourceKind::http; };
    if (!root.has("http") && std::any_of(config.sources.begin(), config.sources.end(), posts))
      root.fail("http",
                "is missing: a source of kind \"http\" needs a server, [http]; for example:\n    "
                "[http]\n    listen = \"127.0.0.1:8080\"");
  });
  problems.in_table(root, "alarm", [&] { config.alarm = read_alarm(root, tracker); });
  if (problems.empty()) {
    root.finish();
  } else {
    problems.in([&] { refuse_unknown_tables(root); });
  }
  problems.finish();
  return config;
}

}  // namespace wearwell::monitor
