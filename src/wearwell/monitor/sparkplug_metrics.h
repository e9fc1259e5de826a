#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/monitor/reading_mapping.h"
#include "wearwell/monitor/sparkplug_payload.h"

namespace wearwell::monitor {

/// Values of one message whose times differ by no more are of one reading.
inline constexpr std::int64_t together_ms = 100;

/// Field of a row: when its reading was taken, Unix time in milliseconds.
inline constexpr std::string_view timestamp_field = "{timestamp}";
/// Unit of measure of a column: the property "engUnit" of its metric.
inline constexpr std::string_view message_unit = "{engUnit}";

/// A metric that a configuration names.
struct SparkplugName {
  std::string text;
  bool measured = false;
  bool fresh =
      false;  ///< counts with the message alone in which it stands: measured, the sequence number, the time
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

/// What is known of a metric that a configuration names, of one edge node or device.
struct KnownMetric {
  bool born = false;
  std::uint32_t type = 0;
  bool good = true;                        ///< its quality, until another is said
  std::string problem = {};                ///< with its unit of measure
  std::optional<Unit> unit = {};           ///< in which it comes, where its message says that
  std::optional<SparkplugValue> now = {};  ///< what holds until another comes
  std::optional<SparkplugValue> before =
      {};  ///< what held before that, for readings that come late
};

/// Takes up what a birth certificate says of it; values stay.
void be_born(KnownMetric& known, const SparkplugName& name, const SparkplugMetric& metric,
             const ReadingMapping& mapping);

/// The value that came, at `sent_ms` where it has no time of its own. Takes up quality and unit of measure where these are said anew.
SparkplugValue value_of(KnownMetric& known, const SparkplugName& name,
                        const SparkplugMetric& metric, std::optional<std::uint64_t> sent_ms,
                        const ReadingMapping& mapping);

/// One reading: its fields, or why it is none.
struct SparkplugReading {
  Fields fields;
  std::string problem;
};

/// A reading is what is measured within `together_ms`, with the values of the other metrics at that time: of the same message the nearest within
/// `together_ms`, else the last before it, else what is known to hold. Of historical values, what holds now counts only if it did then.
std::vector<SparkplugReading> readings_of(const std::vector<SparkplugName>& names,
                                          const std::vector<KnownMetric>& known,
                                          const SparkplugValues& values, bool historical);

/// What holds from this message on.
void hold(const std::vector<SparkplugName>& names, const SparkplugValues& values, bool historical,
          std::vector<KnownMetric>& known);

}  // namespace wearwell::monitor
