#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::monitor {

/// What a message may be at most; more is refused, whatever it says.
inline constexpr std::size_t longest_message = 4 << 20;  ///< bytes
inline constexpr std::size_t longest_row = 1 << 16;      ///< bytes of one object or line
inline constexpr std::size_t most_fields = 256, deepest_message = 16;

/// One value of a message. Fields within objects have their path as name, "/metrics/wear"; at the
/// top they have their own.
struct Field {
  enum class Kind { null, flag, number, text, list };
  std::string name;
  Kind kind = Kind::null;
  double number = 0;         ///< of a number
  std::int64_t integer = 0;  ///< of a number that is whole
  bool whole = false;
  std::string text = {};  ///< of a text
};
using Fields = std::vector<Field>;

/// The field of that name; null where there is none.
const Field* find_field(const Fields& fields, std::string_view name);

/// One object of JSON. Throws InputError: no JSON, no object, too deep, too many fields, a name that
/// stands twice.
Fields fields_of_json(std::string_view text);

/// The cells of a line of CSV, commas between them, quotes as RFC 4180 has them within the line.
/// Throws InputError for a quote that is not closed.
std::vector<std::string> cells_of(std::string_view line);

/// What is known of a message: nothing, or that it is a piece of a stream that began with JSON.
enum class Form { any, json_lines };

/// Calls `row` with the fields of each object or line, and `bad` with what is wrong with one that cannot
/// be read; the others count all the same. A message is an object of JSON, lines of such objects, or CSV
/// with a heading.
void for_each_row(std::string_view payload, const std::function<void(const Fields&)>& row,
                  const std::function<void(const std::string& problem)>& bad,
                  Form form = Form::any);

}  // namespace wearwell::monitor
