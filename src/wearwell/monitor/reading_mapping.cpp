#include "wearwell/monitor/reading_mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_set>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/implausible_reading.h"
#include "wearwell/monitor/time_text.h"
#include "wearwell/monitor/unit_events.h"

// Longer than others: one mapping, from its table in the file to a reading.
namespace wearwell::monitor {
namespace {

std::string shown_value(std::string_view text) {
  return printable(shortened(text));
}

ColumnField read_column_field(const TomlReader& columns, const prognosis::ReadingColumn& column) {
  ColumnField chosen{column.name, column.measured, column.name, Unit{"1", 1, 0},
                     {},          column.carried};
  const auto plain = [&](const TomlReader& at, std::string_view key) {
    if (may_be_plain(column.unit.text) && column.unit.scale == 1) return;
    at.fail(key, fmt::format("has no unit; write {{ field = \"{}\", unit = \"{}\" }}", chosen.field,
                             column.unit.text));
  };
  if (columns.is_text(column.name)) {
    chosen.field = columns.required_text(column.name);
    plain(columns, column.name);
    return chosen;
  }
  const TomlReader table = columns.required_table(column.name);
  for (const char* key : {"field", "unit", "value"})
    table.has(key);  // requested, whatever is wrong
  if (table.has("value")) {
    if (column.measured) table.fail("value", "is measured and cannot be constant");
    if (table.has("field") || table.has("unit"))
      table.fail("value", "is a constant: it has no field, and its unit belongs to its value");
    chosen.constant = required_si(table, "value", column.unit);
    return chosen;
  }
  chosen.field = table.required_text("field");
  const auto unit = table.text("unit");
  if (!unit) {
    plain(table, "unit");
    return chosen;
  }
  if (*unit == "{engUnit}") {
    chosen.unit_of_message = true;
    chosen.unit = Unit{column.unit.text, 1, 0};
    return chosen;
  }
  try {
    chosen.unit = read_unit(*unit, column.unit.text);
  } catch (const InputError& error) {
    table.fail("unit", error.what());
  }
  return chosen;
}

void read_identity(const TomlReader& reading, bool topic_names_unit, ReadingMapping& mapping,
                   Problems& problems) {
  problems.in(
      [&] {
        if (!topic_names_unit) mapping.unit = reading.required_text("unit");
      },
      "unit = \"machine\"");
  problems.in(
      [&] {
        if (topic_names_unit && reading.has("unit"))
          reading.fail("unit",
                       "is given, but the topic names the unit already; remove this, or {unit} in "
                       "the topic");
      },
      "topic = \"plant/+/wear\", or no unit here");
  problems.in([&] { mapping.sequence = reading.text("sequence").value_or(""); },
              "sequence = \"n\"");
  if (reading.has("time")) {
    problems.in([&] { mapping.time = reading.required_text("time"); }, "time = \"t\"");
    problems.in(
        [&] {
          const auto format = reading.choice("time_format", {"iso 8601", "unix s", "unix ms"});
          if (!format)
            reading.fail("time_format", "is missing: \"iso 8601\", \"unix s\" or \"unix ms\"");
          mapping.format = *format == "iso 8601" ? TimeFormat::iso
                           : *format == "unix s" ? TimeFormat::unix_s
                                                 : TimeFormat::unix_ms;
        },
        "time_format = \"iso 8601\"");
  }
  if (reading.has("time") || reading.has("sequence")) return;
  problems.in(
      [&] {
        reading.fail("sequence",
                     "is missing, and so is time: one of these fields must distinguish a reading "
                     "from a repeat");
      },
      "time = \"t\" with time_format = \"iso 8601\"");
}

std::int64_t time_of(const Field& field, TimeFormat format) {
  const auto refuse = [&](const char* expected) {
    throw InputError(fmt::format("{} is {}, but must be {}", shown_value(field.name),
                                 field.kind == Field::Kind::text
                                     ? fmt::format("'{}'", shown_value(field.text))
                                     : fmt::format("{}", field.number),
                                 expected));
  };
  if (format == TimeFormat::iso) {
    const auto time = unix_ms_of_iso(field.text);
    if (field.kind != Field::Kind::text || !time)
      refuse("a time with its zone like 2026-11-22T15:04:05Z");
    return *time;
  }
  const bool seconds = format == TimeFormat::unix_s;
  const double scale = seconds ? 1000 : 1;
  if (field.kind != Field::Kind::number || !(field.number >= 0) ||
      field.number * scale > static_cast<double>(latest_unix_ms))
    refuse(seconds ? "a Unix time in seconds, up to the year 2200"
                   : "a Unix time in milliseconds, up to the year 2200");
  return field.whole ? field.integer * (seconds ? 1000 : 1) : std::llround(field.number * scale);
}

double number_of(const Field* field, const ColumnField& column) {
  if (column.constant) return *column.constant;
  if (!field || field->kind == Field::Kind::null) return std::numeric_limits<double>::quiet_NaN();
  double value = field->number;
  if (field->kind == Field::Kind::text) {
    const char* end = field->text.data() + field->text.size();
    const auto [rest, error] = std::from_chars(field->text.data(), end, value);
    if (error != std::errc() || rest != end || field->text.empty())
      throw InputError(fmt::format("{} is '{}', but must be a number", shown_value(column.field),
                                   shown_value(field->text)));
  } else if (field->kind != Field::Kind::number) {
    throw InputError(fmt::format("{} must be a number", shown_value(column.field)));
  }
  const double si = to_si(column.unit, value);
  if (!std::isfinite(si))
    throw InputError(fmt::format("{} is not a finite number", shown_value(column.field)));
  return si;
}

/// "wear is missing: it has the bad status 2147483648".
[[noreturn]] void fail_missing(const Field* field, const std::string& what) {
  const bool has_reason = field && !field->text.empty();
  throw InputError(fmt::format("{} is missing{}{}", shown_value(what), has_reason ? ": " : "",
                               has_reason ? field->text : ""));
}

/// A valid name of a unit or a label, from a text or a whole number.
std::string name_of(const Field* field, const std::string& what) {
  if (!field || field->kind == Field::Kind::null) fail_missing(field, what);
  std::string name = !field->text.empty() ? field->text
                     : field->whole       ? fmt::format("{}", field->integer)
                                          : std::string();
  if (name.empty() || name.size() > longest_name || printable(name) != name)
    throw InputError(
        fmt::format("{} is '{}', but must be a name of 1 to {} bytes without control characters",
                    shown_value(what), shown_value(name), longest_name));
  return name;
}

/// An incomplete reading is not stored, so that a complete one with the same key may follow.
void refuse_missing(const StoredReading& reading, const Fields& fields,
                    const ReadingMapping& mapping) {
  bool measured = false;
  for (std::size_t i = 0; i < mapping.columns.size(); ++i) {
    const bool there = !std::isnan(reading.numbers[i]);
    if (!there && !mapping.columns[i].measured && !mapping.columns[i].carried)
      fail_missing(find_field(fields, mapping.columns[i].field), mapping.columns[i].field);
    measured = measured || (there && mapping.columns[i].measured);
  }
  if (measured) return;
  for (const ColumnField& column : mapping.columns) {
    if (column.measured) fail_missing(find_field(fields, column.field), column.field);
  }
}

/// Without a tracker: the study may have each of the columns.
void note_columns(const TomlReader& reading) {
  if (!reading.has("columns")) reading.fail("columns", "is missing: the field of each column");
  const TomlReader columns = *reading.table("columns");
  for (const std::string& key : columns.keys()) columns.has(key);
}

void read_columns(const TomlReader& reading, const std::string& path,
                  const prognosis::Tracker& tracker, ReadingMapping& mapping) {
  std::vector<std::string> missing, lines;
  Problems problems;
  const bool some = reading.has("columns");
  const std::optional<TomlReader> columns = reading.table("columns");
  for (const prognosis::ReadingColumn& column : tracker.columns()) {
    if (some && columns->has(column.name)) {
      problems.in([&] { mapping.columns.push_back(read_column_field(*columns, column)); },
                  example_line(column));
      continue;
    }
    missing.push_back(fmt::format("{} [{}]", column.name, column.unit.text));
    lines.push_back(example_line(column));
  }
  for (const std::string& label : tracker.labels()) {
    if (some && columns->has(label)) {
      problems.in([&] { mapping.labels.push_back(columns->required_text(label)); },
                  example_line(label));
      continue;
    }
    missing.push_back(label);
    lines.push_back(example_line(label));
  }
  if (!missing.empty()) {
    if (!some) lines.insert(lines.begin(), fmt::format("[{}.columns]", path));
    problems.in([&] {
      reading.fail("columns",
                   fmt::format("the study has {}{}; give the field of each; for example:\n    {}",
                               fmt::join(missing, ", "), some ? " as well" : "",
                               fmt::join(lines, "\n    ")));
    });
  }
  problems.finish();
}

}  // namespace

ReadingMapping tracker_checks(const prognosis::Tracker& tracker) {
  ReadingMapping mapping;
  mapping.implausible = implausible_reading(tracker);
  mapping.refusal = [&tracker](const std::string& unit) { return tracker.refusal(unit); };
  mapping.event_problem = [&tracker,
                           implausible = implausible_event(tracker)](const UnitEvent& event) {
    const std::string problem = event_problem(event, tracker);
    return problem.empty() ? implausible(event) : problem;
  };
  mapping.in_study = [names = std::make_shared<const std::unordered_set<std::string>>(
                          tracker.seen().begin(), tracker.seen().end())](const std::string& unit) {
    return names->contains(unit);
  };
  mapping.watched = prognosis::watched_columns(tracker);
  return mapping;
}

double required_si(const TomlReader& table, const std::string& key, const Unit& like) {
  const Quantity quantity = table.required_quantity(key, like.text);
  try {
    refuse_two_readings(quantity, like);
  } catch (const InputError& error) {
    table.fail(key, error.what());
  }
  return quantity.si();
}

std::string example_line(const prognosis::ReadingColumn& column) {
  return fmt::format("{} = {{ field = \"{}\", unit = \"{}\" }}", column.name, column.name,
                     column.unit.text);
}

std::string example_line(const std::string& label) {
  return fmt::format("{} = \"{}\"", label, label);
}

std::string example_columns(const prognosis::Tracker* tracker) {
  if (!tracker)
    return "# for each column that the study reads: COLUMN = { field = \"FIELD\", unit = \"UNIT\" "
           "}";
  std::vector<std::string> lines;
  for (const prognosis::ReadingColumn& each : tracker->columns())
    lines.push_back(example_line(each));
  for (const std::string& each : tracker->labels()) lines.push_back(example_line(each));
  return fmt::format("{}", fmt::join(lines, "\n    "));
}

ReadingMapping read_mapping(const TomlReader& reading, const std::string& path,
                            const prognosis::Tracker* tracker, bool topic_names_unit) {
  ReadingMapping mapping = tracker ? tracker_checks(*tracker) : ReadingMapping{};
  Problems problems;
  read_identity(reading, topic_names_unit, mapping, problems);
  problems.in([&] { mapping.event = reading.text("event").value_or(""); }, "event = \"event\"");
  problems.in([&] {
    if (tracker) {
      read_columns(reading, path, *tracker, mapping);
    } else {
      note_columns(reading);
    }
  });
  problems.finish();
  return mapping;
}

ReadingMapping plain_mapping(const prognosis::Tracker& tracker, bool keys_are_times) {
  ReadingMapping mapping = tracker_checks(tracker);
  (keys_are_times ? mapping.time : mapping.sequence) = "key";
  mapping.format = TimeFormat::unix_ms;
  mapping.event = "event";
  for (const prognosis::ReadingColumn& each : tracker.columns())
    mapping.columns.push_back({each.name, each.measured, each.name, each.unit, {}, each.carried});
  mapping.labels.assign(tracker.labels().begin(), tracker.labels().end());
  return mapping;
}

std::vector<std::string> needed_fields(const ReadingMapping& mapping) {
  std::vector<std::string> fields;
  for (const std::string* each : {&mapping.unit, &mapping.sequence, &mapping.time}) {
    if (!each->empty()) fields.push_back(*each);
  }
  for (const ColumnField& each : mapping.columns) {
    if (!each.constant && !each.measured) fields.push_back(each.field);
  }
  fields.insert(fields.end(), mapping.labels.begin(), mapping.labels.end());
  return fields;
}

StoredReading identity_of(const Fields& fields, const std::string& unit,
                          const ReadingMapping& mapping, std::int64_t received_ms) {
  StoredReading reading;
  if (mapping.unit.empty()) {
    Field topic{"{unit}", Field::Kind::text};
    topic.text = unit;
    reading.unit = name_of(&topic, "the unit of the topic");
  } else {
    reading.unit = name_of(find_field(fields, mapping.unit), mapping.unit);
  }
  if (mapping.refusal) {
    if (const std::string why = mapping.refusal(reading.unit); !why.empty()) throw InputError(why);
  }
  reading.received_ms = received_ms;
  if (!mapping.time.empty()) {
    const Field* time = find_field(fields, mapping.time);
    if (!time || time->kind == Field::Kind::null) fail_missing(time, mapping.time);
    reading.time_ms = time_of(*time, mapping.format);
  }
  reading.key = reading.time_ms;
  if (!mapping.sequence.empty()) {
    const Field* sequence = find_field(fields, mapping.sequence);
    if (!sequence || sequence->kind == Field::Kind::null) fail_missing(sequence, mapping.sequence);
    if (sequence->kind != Field::Kind::number || !sequence->whole)
      throw InputError(fmt::format("{} must be a whole number", shown_value(mapping.sequence)));
    reading.key = sequence->integer;
  }
  return reading;
}

double value_of(const Fields& fields, const ColumnField& column) {
  return number_of(column.constant ? nullptr : find_field(fields, column.field), column);
}

StoredReading reading_of(const Fields& fields, const std::string& unit,
                         const ReadingMapping& mapping, std::int64_t received_ms) {
  StoredReading reading = identity_of(fields, unit, mapping, received_ms);
  for (const ColumnField& column : mapping.columns)
    reading.numbers.push_back(value_of(fields, column));
  refuse_missing(reading, fields, mapping);
  for (const std::string& label : mapping.labels)
    reading.labels.push_back(name_of(find_field(fields, label), label));
  if (mapping.implausible) {
    if (const std::string why = mapping.implausible(reading); !why.empty()) throw InputError(why);
  }
  return reading;
}

}  // namespace wearwell::monitor
