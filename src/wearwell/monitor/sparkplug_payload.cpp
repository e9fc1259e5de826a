#include "wearwell/monitor/sparkplug_payload.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <protozero/pbf_reader.hpp>
#include <protozero/pbf_writer.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

// Numbers of fields: Sparkplug B, specification 3.0.0, 6.4.1 (Google Protocol Buffers, proto2). No
// function here is recursive, so that nesting depth is not limited.
namespace wearwell::monitor {
namespace {

using protozero::pbf_reader;
using protozero::pbf_wire_type;
using Holds = SparkplugMetric::Holds;

constexpr std::uint32_t with(std::uint32_t field, pbf_wire_type type) {
  return protozero::tag_and_type(field, type);
}
constexpr auto varint = pbf_wire_type::varint;
constexpr auto fixed32 = pbf_wire_type::fixed32;
constexpr auto fixed64 = pbf_wire_type::fixed64;
constexpr auto bytes = pbf_wire_type::length_delimited;

std::string_view view_of(pbf_reader& reader) {
  const protozero::data_view view = reader.get_view();
  return {view.data(), view.size()};
}

protozero::data_view data_of(std::string_view text) {
  return {text.data(), text.size()};
}

/// The texts and whole numbers of a PropertyValue; skips the rest.
void read_property(std::string_view key, std::string_view value, SparkplugMetric& metric) {
  pbf_reader reader(data_of(value));
  std::optional<std::uint64_t> whole;
  std::optional<std::string_view> text;
  bool null = false;
  while (reader.next()) {
    switch (reader.tag_and_type()) {
      case with(2, varint):
        null = reader.get_bool();
        break;
      case with(3, varint):
      case with(4, varint):
        whole = reader.get_uint64();
        break;
      case with(8, bytes):
        text = view_of(reader);
        break;
      default:
        reader.skip();
    }
  }
  if (null) return;
  if (key == "engUnit") metric.eng_unit = text;
  if (key == "Quality" && whole) metric.quality = static_cast<std::uint32_t>(*whole);
}

/// A PropertySet: keys and values are two lists of the same length.
void read_properties(std::string_view set, SparkplugMetric& metric) {
  pbf_reader reader(data_of(set));
  std::vector<std::string_view> keys, values;
  while (reader.next()) {
    if (keys.size() > most_properties || values.size() > most_properties)
      throw InputError(fmt::format("has a metric with more than {} properties", most_properties));
    switch (reader.tag_and_type()) {
      case with(1, bytes):
        keys.push_back(view_of(reader));
        break;
      case with(2, bytes):
        values.push_back(view_of(reader));
        break;
      default:
        reader.skip();
    }
  }
  if (keys.size() != values.size())
    throw InputError(fmt::format("has a metric with {} property names and {} values", keys.size(),
                                 values.size()));
  for (std::size_t i = 0; i < keys.size(); ++i) read_property(keys[i], values[i], metric);
}

/// The fields that hold its value; false if this is none of them.
bool read_value(pbf_reader& reader, SparkplugMetric& metric) {
  switch (reader.tag_and_type()) {
    case with(10, varint):
      metric.holds = Holds::bits32;
      metric.bits = static_cast<std::uint32_t>(reader.get_uint64());
      return true;
    case with(11, varint):
      metric.holds = Holds::bits64;
      metric.bits = reader.get_uint64();
      return true;
    case with(12, fixed32):
      metric.holds = Holds::number;
      metric.number = reader.get_float();
      return true;
    case with(13, fixed64):
      metric.holds = Holds::number;
      metric.number = reader.get_double();
      return true;
    case with(14, varint):
      metric.holds = Holds::flag;
      metric.bits = reader.get_bool();
      return true;
    case with(15, bytes):
      metric.holds = Holds::text;
      metric.text = view_of(reader);
      return true;
    case with(16, bytes):
    case with(17, bytes):
    case with(18, bytes):
    case with(19, bytes):
      metric.holds = Holds::other;
      reader.skip();
      return true;
    default:
      return false;
  }
}

SparkplugMetric read_metric(std::string_view message) {
  SparkplugMetric metric;
  pbf_reader reader(data_of(message));
  while (reader.next()) {
    switch (reader.tag_and_type()) {
      case with(1, bytes):
        metric.name = view_of(reader);
        break;
      case with(2, varint):
        metric.alias = reader.get_uint64();
        break;
      case with(3, varint):
        metric.timestamp = reader.get_uint64();
        break;
      case with(4, varint):
        metric.type = reader.get_uint32();
        break;
      case with(5, varint):
        metric.historical = reader.get_bool();
        break;
      case with(7, varint):
        metric.null = reader.get_bool();
        break;
      case with(9, bytes):
        read_properties(view_of(reader), metric);
        break;
      default:
        if (!read_value(reader, metric)) reader.skip();
    }
  }
  return metric;
}

SparkplugPayload read_payload(std::string_view message) {
  SparkplugPayload payload;
  pbf_reader reader(data_of(message));
  while (reader.next()) {
    switch (reader.tag_and_type()) {
      case with(1, varint):
        payload.timestamp = reader.get_uint64();
        break;
      case with(2, bytes):
        if (payload.metrics.size() == most_metrics)
          throw InputError(fmt::format("has more than {} metrics", most_metrics));
        payload.metrics.push_back(read_metric(view_of(reader)));
        break;
      case with(3, varint):
        payload.sequence = reader.get_uint64();
        break;
      case with(4, bytes):
        if (view_of(reader) == "SPBV1.0_COMPRESSED")
          throw InputError("is compressed, which is not supported");
        break;
      default:
        reader.skip();
    }
  }
  return payload;
}

/// A two's complement of `width` bits that was written in its own width, in 32 or in 64 bits.
std::int64_t signed_of(const SparkplugMetric& metric, int width, const std::string& name) {
  const std::int64_t largest = std::numeric_limits<std::int64_t>::max() >> (64 - width);
  const std::uint64_t bits = metric.bits;
  // 64 bits of which only 32 are present are ambiguous.
  const bool cut = width == 64 && metric.holds == Holds::bits32 && bits >> 31 != 0;
  if (!cut && bits <= static_cast<std::uint64_t>(largest)) return static_cast<std::int64_t>(bits);
  for (const int written : {width, 32, 64}) {
    if (written < width || (metric.holds == Holds::bits32 && written > 32)) continue;
    const std::uint64_t above = written == 64 ? 0 : ~std::uint64_t{0} << written;
    const auto value = static_cast<std::int64_t>(bits | above);
    if ((bits & above) == 0 && value < 0 && value >= -largest - 1) return value;
  }
  throw InputError(fmt::format("{} is {}, which is not a signed number of {} bits",
                               printable(shortened(name)), bits, width));
}

std::uint64_t unsigned_of(const SparkplugMetric& metric, int width, const std::string& name) {
  if (width < 64 && metric.bits >> width != 0)
    throw InputError(fmt::format("{} is {}, which is not a number of {} bits",
                                 printable(shortened(name)), metric.bits, width));
  return metric.bits;
}

Field whole_field(Field field, std::int64_t value) {
  field.kind = Field::Kind::number;
  field.number = static_cast<double>(value);
  field.integer = value;
  field.whole = true;
  return field;
}

Field unsigned_field(Field field, std::uint64_t value) {
  if (value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    return whole_field(std::move(field), static_cast<std::int64_t>(value));
  field.kind = Field::Kind::number;
  field.number = static_cast<double>(value);
  return field;
}

Field number_field(Field field, double value) {
  constexpr double exact = 9007199254740992.0;  // 2^53
  field.kind = Field::Kind::number;
  field.number = value;
  field.whole = value == std::floor(value) && std::abs(value) <= exact;
  field.integer = field.whole ? static_cast<std::int64_t>(value) : 0;
  return field;
}

}  // namespace

SparkplugPayload read_sparkplug(std::string_view message) {
  if (message.size() > longest_message)
    throw InputError(fmt::format("has {} bytes; the limit is {}", message.size(), longest_message));
  try {
    return read_payload(message);
  } catch (const protozero::exception& error) {
    throw InputError(fmt::format("is not a payload of Sparkplug B: {}", error.what()));
  }
}

Field field_of(const SparkplugMetric& metric, std::uint32_t type, const std::string& name) {
  Field field{name};
  if (metric.null || metric.holds == Holds::nothing) return field;
  const auto expect = [&](bool good, const char* what) {
    if (!good)
      throw InputError(fmt::format("{} has type {}, but another kind of value",
                                   printable(shortened(name)), what));
  };
  const bool whole = metric.holds == Holds::bits32 || metric.holds == Holds::bits64;
  const auto kind = static_cast<SparkplugType>(type);
  switch (kind) {
    case SparkplugType::int8:
    case SparkplugType::int16:
    case SparkplugType::int32:
    case SparkplugType::int64:
      expect(whole, "a whole number");
      return whole_field(std::move(field), signed_of(metric, 4 << type, name));
    case SparkplugType::uint8:
    case SparkplugType::uint16:
    case SparkplugType::uint32:
    case SparkplugType::uint64:
      expect(whole, "a whole number");
      return unsigned_field(std::move(field), unsigned_of(metric, 4 << (type - 4), name));
    case SparkplugType::date_time:
      expect(whole, "a time");
      return unsigned_field(std::move(field), metric.bits);
    case SparkplugType::float32:
    case SparkplugType::float64:
      expect(metric.holds == Holds::number, "a number");
      return number_field(std::move(field), metric.number);
    case SparkplugType::boolean:
      expect(metric.holds == Holds::flag, "a flag");
      field.kind = Field::Kind::flag;
      return field;
    case SparkplugType::string:
    case SparkplugType::text:
    case SparkplugType::uuid:
      expect(metric.holds == Holds::text, "a text");
      if (metric.text.size() > longest_metric_text)
        throw InputError(fmt::format("{} is a text of {} bytes", printable(shortened(name)),
                                     metric.text.size()));
      field.kind = Field::Kind::text;
      field.text = metric.text;
      return field;
  }
  throw InputError(fmt::format("{} has Sparkplug type {}, which is neither a number nor a text",
                               printable(shortened(name)), type));
}

std::string rebirth_request(std::int64_t now_ms) {
  const auto now = static_cast<std::uint64_t>(now_ms);
  std::string metric, payload;
  protozero::pbf_writer inner(metric);
  inner.add_string(1, "Node Control/Rebirth");
  inner.add_uint64(3, now);
  inner.add_uint32(4, static_cast<std::uint32_t>(SparkplugType::boolean));
  inner.add_bool(14, true);
  protozero::pbf_writer outer(payload);
  outer.add_uint64(1, now);
  outer.add_message(2, metric);
  return payload;
}

}  // namespace wearwell::monitor
