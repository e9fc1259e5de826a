#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/monitor/message.h"

namespace wearwell::monitor {

/// Types of Sparkplug B (specification 3.0.0, 6.4.15) that a metric may have.
enum class SparkplugType : std::uint32_t {
  int8 = 1,
  int16 = 2,
  int32 = 3,
  int64 = 4,
  uint8 = 5,
  uint16 = 6,
  uint32 = 7,
  uint64 = 8,
  float32 = 9,
  float64 = 10,
  boolean = 11,
  string = 12,
  date_time = 13,
  text = 14,
  uuid = 15
};

inline constexpr std::size_t most_metrics = 100'000;  ///< of one message
inline constexpr std::size_t most_properties = 1000;  ///< of one metric
inline constexpr std::size_t longest_metric_text =
    1000;  ///< bytes of a value, an alias' name or a unit

/// One metric of a message. Its texts are views into the message.
struct SparkplugMetric {
  enum class Holds { nothing, bits32, bits64, number, flag, text, other };

  std::optional<std::string_view> name;
  std::optional<std::uint64_t> alias;
  std::optional<std::uint64_t> timestamp;  ///< Unix time in milliseconds
  std::uint32_t type = 0;                  ///< 0: missing, as in data after a birth certificate
  bool historical = false, null = false;
  Holds holds = Holds::nothing;
  std::uint64_t bits = 0;
  double number = 0;
  std::string_view text;
  std::optional<std::string_view> eng_unit;  ///< property "engUnit": the unit of measure
  std::optional<std::uint32_t> quality;      ///< property "Quality": 0 bad, 192 good, 500 stale
};

/// A parsed message of Sparkplug B; templates, data sets, files and metadata are skipped.
struct SparkplugPayload {
  std::optional<std::uint64_t> timestamp;
  std::uint64_t sequence = 0;  ///< 0 if missing, as encoders of proto3 omit a 0
  std::vector<SparkplugMetric> metrics;
};

/// Throws InputError: not a protocol buffer, truncated, compressed, too many metrics. Views are
/// valid as long as `bytes`.
SparkplugPayload read_sparkplug(std::string_view bytes);

/// The value of a metric of that type (its own, or that of its birth certificate), under that name.
/// Signed numbers of 8 to 64 bits are two's complements in their own width, 32 or 64 bits, as
/// encoders differ. Throws InputError: a value of another type, outside its range, of a type that
/// is neither number nor text.
Field field_of(const SparkplugMetric& metric, std::uint32_t type, const std::string& name);

/// The request to an edge node for its birth certificates: payload of NCMD.
std::string rebirth_request(std::int64_t now_ms);

}  // namespace wearwell::monitor
