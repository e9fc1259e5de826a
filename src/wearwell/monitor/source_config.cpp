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
  table.has("precision");  // requested, whatever is wrong
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
[[noreturn]] void fail_without_reading(const TomlReader& root, const prognosis::Tracker* tracker) {
  const bool named = tracker && !tracker->noun().empty();
  root.fail(
      "reading",
      fmt::format("is missing: the fields of a message; for example:\n    [reading]\n    unit "
                  "= \"{}\"\n    time = \"t\"\n    time_format = \"iso 8601\"\n    "
                  "[reading.columns]\n    {}",
                  named ? tracker->noun() : "unit", example_columns(tracker)));
}

/// What is wrong in [reading] where no source can be read that uses it.
void check_reading(const TomlReader& root, const prognosis::Tracker* tracker) {
  if (!root.has("reading")) fail_without_reading(root, tracker);
  const TomlReader reading = root.required_table("reading");
  // A topic may name the unit.
  read_mapping(reading, "reading", tracker, !reading.has("unit"));
}

constexpr std::initializer_list<const char*> source_keys = {
    "kind", "reading",       "format",    "precision", "folder", "broker", "topic", "client",
    "user", "password_file", "authority", "protocol",  "group",  "edge",   "host",  "births"};

SourceKind read_kind(const TomlReader& table) {
  const auto kind = table.choice("kind", {"stdin", "folder", "mqtt", "sparkplug", "http"});
  if (!kind)
    table.fail("kind", "is missing: \"stdin\", \"folder\", \"mqtt\", \"sparkplug\" or \"http\"");
  return *kind == "folder"      ? SourceKind::folder
         : *kind == "mqtt"      ? SourceKind::mqtt
         : *kind == "sparkplug" ? SourceKind::sparkplug
         : *kind == "http"      ? SourceKind::http
                                : SourceKind::stdin;
}

std::filesystem::path read_folder(const TomlReader& table) {
  const std::filesystem::path folder = existing(table, "folder");
  if (!std::filesystem::is_directory(folder))
    table.fail("folder", fmt::format("{} is not a folder", folder.string()));
  return folder;
}

SourceSettings read_source(const TomlReader& root, const TomlReader& table, const std::string& name,
                           const prognosis::Tracker* tracker) {
  SourceSettings source;
  source.name = name;
  Problems problems;
  const bool known = problems.in([&] { source.kind = read_kind(table); }, "kind = \"stdin\"");
  if (!known) {
    for (const char* key : source_keys) table.has(key);
    problems.in([&] {
      if (!table.has("reading")) check_reading(root, tracker);
    });
    problems.finish();
  }
  if (source.kind == SourceKind::folder) {
    problems.in([&] { source.folder = read_folder(table); },
                "folder = \"incoming\", after mkdir incoming beside this file");
  } else if (source.kind == SourceKind::mqtt) {
    problems.in([&] { source.broker = read_broker(table, "wearwell-" + name); });
    problems.in([&] { source.topic = read_topic(table); }, "topic = \"plant/{unit}/wear\"");
  } else if (source.kind == SourceKind::sparkplug) {
    problems.in([&] { read_sparkplug_source(table, name, source); });
  }
  problems.in([&] { read_format(table, source); }, "format = \"influx\" with precision = \"ns\"");
  problems.in([&] {
    const auto own = table.table("reading");
    if (!own && !root.has("reading")) fail_without_reading(root, tracker);
    const TomlReader reading = own ? *own : root.required_table("reading");
    const std::string path = own ? fmt::format("source.{}.reading", name) : "reading";
    source.mapping = read_mapping(reading, path, tracker, source.topic.names_unit());
    check_braces(reading, source);
  });
  problems.finish();
  return source;
}

[[noreturn]] void fail_without_source(const TomlReader& root, const char* problem) {
  root.fail("source",
            fmt::format("{}; for example:\n    [source.line]\n    kind = \"stdin\"", problem));
}

}  // namespace

void read_sources(const TomlReader& root, const prognosis::Tracker* tracker, MonitorConfig& config,
                  Problems& problems) {
  std::vector<std::string> names;
  const bool listed = problems.in([&] {
    if (!root.has("source")) fail_without_source(root, "is missing: where readings come from");
    names = root.required_table("source").keys();
    if (names.empty()) fail_without_source(root, "has no source");
  });
  if (!listed) {
    problems.in([&] { check_reading(root, tracker); });
    return;
  }
  const TomlReader sources = root.required_table("source");
  const auto read_one = [&](const std::string& name) {
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
  bool shared = false;
  for (const std::string& name : names) {
    problems.in([&] { read_one(name); });
    problems.in([&] {
      const auto table = sources.table(name);
      shared = shared || !table || !table->has("reading");
    });
  }
  if (shared || !root.has("reading")) return;
  problems.in(
      [&] { root.fail("reading", "is not used: each source has a [source.NAME.reading]"); });
}

}  // namespace wearwell::monitor
