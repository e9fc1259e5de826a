#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::monitor {

/// Limits of a message; larger ones are refused.
inline constexpr std::size_t longest_message = 4 << 20;  ///< bytes
inline constexpr std::size_t longest_row = 1 << 16;      ///< bytes of one object or line
inline constexpr std::size_t most_fields = 256, deepest_message = 16;

/// One value of a message. Nested fields have their path as name, "/metrics/wear"; top-level fields
/// their own.
struct Field {
  enum class Kind { null, flag, number, text, list };
  std::string name;
  Kind kind = Kind::null;
  double number = 0;         ///< of a number
  std::int64_t integer = 0;  ///< of a number that is whole
  bool whole = false;
  std::string text = {};  ///< of a text; of a null the reason, if there is one
};
using Fields = std::vector<Field>;

/// The field with that name; null if there is none.
const Field* find_field(const Fields& fields, std::string_view name);

/// What is wrong with a line of CSV that has semicolons or tabs; empty without them.
std::string separator_problem(std::string_view line);

/// One object of JSON. Throws InputError: not JSON, not an object, too deep, too many fields, a
/// repeated name.
Fields fields_of_json(std::string_view text);

/// The cells of a line of CSV, separated by commas, quoted by RFC 4180 within the line. Throws
/// InputError for an unclosed quote.
std::vector<std::string> cells_of(std::string_view line);

/// How a message is written: JSON or CSV, by its content; JSON, in a stream that began with it; the
/// line protocol of InfluxDB; JSON of OPC UA PubSub.
enum class Form { any, json_lines, influx, opc_ua };

/// The form of a source's messages.
struct MessageFormat {
  Form form = Form::any;
  std::int64_t per_second = 1'000'000'000;  ///< of `influx`: the unit of times
};

/// Calls `row` with the fields of each object or line, and `bad` with the error of an unreadable
/// one; the others still count. A message is an object of JSON, lines of such objects, or CSV with
/// a heading.
void for_each_row(std::string_view payload, const std::function<void(const Fields&)>& row,
                  const std::function<void(const std::string& problem)>& bad,
                  Form form = Form::any);

}  // namespace wearwell::monitor
