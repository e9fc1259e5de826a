#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/monitor/message.h"
#include "wearwell/monitor/store.h"
#include "wearwell/monitor/unit_event.h"
#include "wearwell/prognosis/change_watch.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

enum class TimeFormat { iso, unix_s, unix_ms };

/// The source of a column's values.
struct ColumnField {
  std::string column;  ///< of the study, for messages
  bool measured = false;
  std::string field;               ///< of the message
  Unit unit;                       ///< unit of its value there
  std::optional<double> constant;  ///< SI: constant value, instead of a field
  bool carried = false;            ///< as prognosis::ReadingColumn
  bool unit_of_message = false;    ///< its metric has the unit (Sparkplug B); `unit` is SI then
};

/// The mapping from the fields of a message to a reading: [reading] of a configuration.
struct ReadingMapping {
  std::string unit;  ///< field; empty: the topic names it
  std::string time;  ///< field; empty: messages have no time
  TimeFormat format = TimeFormat::iso;
  std::string sequence;              ///< field; empty: time distinguishes readings
  std::vector<ColumnField> columns;  ///< as Tracker::columns
  std::vector<std::string> labels;   ///< fields, as Tracker::labels
  std::function<std::string(const std::string& unit)> refusal = {};  ///< Tracker::refusal
  /// Why a reading is refused, see `implausible_reading`.
  std::function<std::string(const StoredReading& reading)> implausible = {};
  std::string event = {};  ///< field: rows that have it are events; empty: none are
  /// Why an event is refused, see `event_problem`.
  std::function<std::string(const UnitEvent& event)> event_problem = {};
  /// Whether the study has a unit of this name.
  std::function<bool(const std::string& unit)> in_study = {};
  prognosis::WatchedColumns watched = {};
};

/// A quantity with the dimension of `like`, in SI. Throws for a plain number if the unit's size is
/// not 1.
double required_si(const TomlReader& table, const std::string& key, const Unit& like);

inline constexpr std::size_t longest_name = 200;  ///< bytes of a unit's name, or of a label

/// The line of [reading.columns] for a column or label of the study, for examples.
std::string example_line(const prognosis::ReadingColumn& column);
std::string example_line(const std::string& label);
/// The lines of all, each after "\n    " but the first; a comment without a tracker.
std::string example_columns(const prognosis::Tracker* tracker);

/// Reads the table at `path` ("reading"). `topic_names_unit`: then no field may. Without a tracker (null) the columns are not
/// checked, and the mapping has none. Throws InputErrors with all problems, each with file, place and
/// key: a column without a field or a unit, neither time nor sequence, ...
ReadingMapping read_mapping(const TomlReader& reading, const std::string& path,
                            const prognosis::Tracker* tracker, bool topic_names_unit);

/// What a tracker says to readings and events, without fields. The tracker must outlive it.
ReadingMapping tracker_checks(const prognosis::Tracker& tracker);

/// The required fields of a row: its identifier, conditions and labels.
std::vector<std::string> needed_fields(const ReadingMapping& mapping);

/// The mapping of rows whose fields are the study's columns, in its units, with a whole number
/// `key`, a time in Unix milliseconds or a sequence number; the unit is given beside them.
ReadingMapping plain_mapping(const prognosis::Tracker& tracker, bool keys_are_times);

/// The unit, key and times of a row; no values. As `reading_of`.
StoredReading identity_of(const Fields& fields, const std::string& unit,
                          const ReadingMapping& mapping, std::int64_t received_ms);
/// A column's value in SI; NaN if the row has none. Throws InputError that names the field.
double value_of(const Fields& fields, const ColumnField& column);

/// The reading in a row of a message. `unit`: from the topic, or empty. Throws InputError that
/// names the field and its value.
StoredReading reading_of(const Fields& fields, const std::string& unit,
                         const ReadingMapping& mapping, std::int64_t received_ms);

}  // namespace wearwell::monitor
