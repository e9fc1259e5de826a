#include "wearwell/monitor/source_config.h"

#include <fmt/format.h>
#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/monitor/broker_config.h"
#include "wearwell/monitor/config_values.h"
#include "wearwell/monitor/foreign_message.h"
#include "wearwell/monitor/sparkplug_metrics.h"
#include "wearwell/monitor/sparkplug_topic.h"

namespace wearwell::monitor {
namespace {

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

}  // namespace

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

}  // namespace wearwell::monitor
