#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/monitor/message.h"
#include "wearwell/monitor/store.h"
#include "wearwell/prognosis/tracker.h"

namespace wearwell::monitor {

enum class TimeFormat { iso, unix_s, unix_ms };

/// Where the number of a column comes from.
struct ColumnField {
  std::string column;  ///< of the study, for messages
  bool measured = false;
  std::string field;               ///< of the message
  Unit unit;                       ///< that its number has there
  std::optional<double> constant;  ///< SI: of every reading, instead of a field
  bool unit_of_message = false;    ///< its metric says the unit (Sparkplug B); `unit` is SI then
};

/// How the fields of a message become a reading: [reading] of a configuration.
struct ReadingMapping {
  std::string unit;  ///< field; empty: the topic names it
  std::string time;  ///< field; empty: messages have no time
  TimeFormat format = TimeFormat::iso;
  std::string sequence;              ///< field; empty: time tells readings apart
  std::vector<ColumnField> columns;  ///< as Tracker::columns
  std::vector<std::string> labels;   ///< fields, as Tracker::labels
  std::function<std::string(const std::string& unit)> refusal = {};  ///< Tracker::refusal
};

/// A quantity of the kind of `like`, in SI. A plain number beside a unit of another size than 1 is refused.
double required_si(const TomlReader& table, const std::string& key, const Unit& like);

inline constexpr std::size_t longest_name = 200;  ///< bytes of a unit's name, or of a label

/// `topic_names_unit`: then no field may. Throws InputError with file, place and key: a column without a field or a unit,
/// neither time nor sequence, ...
ReadingMapping read_mapping(const TomlReader& reading, const prognosis::Tracker& tracker,
                            bool topic_names_unit);

/// The fields without which no row is a reading: what tells it apart, conditions and labels.
std::vector<std::string> needed_fields(const ReadingMapping& mapping);

/// The reading that a row of a message is. `unit`: of the topic, or empty. Throws InputError that names the field and its value.
StoredReading reading_of(const Fields& fields, const std::string& unit,
                         const ReadingMapping& mapping, std::int64_t received_ms);

}  // namespace wearwell::monitor
