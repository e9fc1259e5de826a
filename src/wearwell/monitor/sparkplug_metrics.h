#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/monitor/reading_mapping.h"
#include "wearwell/monitor/sparkplug_payload.h"

namespace wearwell::monitor {

/// Values of one message whose times differ by at most this belong to one reading.
inline constexpr std::int64_t together_ms = 100;

/// Field of a row: the time of its reading, Unix time in milliseconds.
inline constexpr std::string_view timestamp_field = "{timestamp}";
/// Unit of measure of a column: the property "engUnit" of its metric.
inline constexpr std::string_view message_unit = "{engUnit}";

/// A metric named in a configuration.
struct SparkplugName {
  std::string text;
  bool measured = false;
  bool fresh =
      false;  ///< valid only within its own message: measured values, the sequence number, the time
};
std::vector<SparkplugName> sparkplug_names(const ReadingMapping& mapping);

/// A value at a time, or why there is none.
struct SparkplugValue {
  Field field = {};
  std::string problem = {};
  std::int64_t time_ms = 0;
};
/// Those of one message, by name and in the order of their times.
using SparkplugValues = std::vector<std::vector<SparkplugValue>>;

/// The state of a metric named in a configuration, for one edge node or device.
struct KnownMetric {
  bool born = false;
  std::uint32_t type = 0;
  bool good = true;                           ///< its quality, until it changes
  std::string problem = {};                   ///< with its unit of measure
  std::optional<Unit> unit = {};              ///< its unit, if its message gives one
  std::optional<SparkplugValue> now = {};     ///< the current value
  std::optional<SparkplugValue> before = {};  ///< the value before it, for late readings
};

/// Reads its entry in a birth certificate; values stay.
void be_born(KnownMetric& known, const SparkplugName& name, const SparkplugMetric& metric,
             const ReadingMapping& mapping);

/// A new value, at `sent_ms` if it has no time of its own. Updates quality and unit of measure if
/// given.
SparkplugValue value_of(KnownMetric& known, const SparkplugName& name,
                        const SparkplugMetric& metric, std::optional<std::uint64_t> sent_ms,
                        const ReadingMapping& mapping);

/// One reading: its fields, or why it is invalid.
struct SparkplugReading {
  Fields fields;
  std::string problem;
};

/// A reading is what is measured within `together_ms`, with the values of the other metrics at that
/// time: from the same message the nearest within `together_ms`, else the last before it, else the
/// current value. For historical values, the current value counts only if it was valid then.
std::vector<SparkplugReading> readings_of(const std::vector<SparkplugName>& names,
                                          const std::vector<KnownMetric>& known,
                                          const SparkplugValues& values, bool historical);

/// The current values from this message on.
void hold(const std::vector<SparkplugName>& names, const SparkplugValues& values, bool historical,
          std::vector<KnownMetric>& known);

}  // namespace wearwell::monitor
