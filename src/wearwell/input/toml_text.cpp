#include "wearwell/input/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "wearwell/base/error.h"
#include "wearwell/base/trimmed.h"

namespace wearwell {
namespace {

constexpr int most_parts = 32;  // limit for the parts of a dotted key

/// The length of the string or comment that begins at `at`; 0 if there is none.
std::size_t skipped(const std::string& text, std::size_t at) {
  const char quote = text[at];
  if (quote == '#') return std::min(text.find('\n', at), text.size()) - at;
  if (quote != '"' && quote != '\'') return 0;
  const bool long_one = text.compare(at, 3, std::string(3, quote)) == 0;
  const std::string end(long_one ? 3 : 1, quote);
  for (std::size_t i = at + end.size(); i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text.compare(i, end.size(), end) == 0) {
      return i + end.size() - at;
    } else if (text[i] == '\n' && !long_one) {
      return i - at;  // not closed; the parser reports it better
    }
  }
  return text.size() - at;
}

std::string_view line_of(std::string_view text, std::size_t line) {
  for (std::size_t i = 1; i < line && !text.empty(); ++i)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find_first_of("\r\n"));
}

bool has_open_quote(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#') return false;
    if (line[i] != '"' && line[i] != '\'') continue;
    if (line.compare(i, 3, std::string(3, line[i])) == 0) return false;  // a multi-line string
    const char quote = line[i++];
    while (i < line.size() && line[i] != quote) i += line[i] == '\\' && quote == '"' ? 2 : 1;
    if (i >= line.size()) return true;
  }
  return false;
}

// "0,5" and "9.5 mm" before a comment, a comma or a closing bracket.
std::string slip_of_number(std::string_view value) {
  const auto digits = [&](std::size_t from) {
    return std::min(value.find_first_not_of("0123456789", from), value.size());
  };
  std::size_t end = digits(value.starts_with('+') || value.starts_with('-'));
  if (end < value.size() && value[end] == '.') end = digits(end + 1);
  const std::size_t comma = end;
  const bool has_comma =
      comma < value.size() && value[comma] == ',' && digits(comma + 1) > comma + 1;
  if (has_comma) end = digits(comma + 1);
  if (end + 1 < value.size() && (value[end] == 'e' || value[end] == 'E')) {
    const std::size_t sign = value[end + 1] == '-' || value[end + 1] == '+';
    if (digits(end + 1 + sign) > end + 1 + sign) end = digits(end + 1 + sign);
  }
  const std::string_view unit = trimmed(value.substr(end, value.find_first_of("#,]}", end) - end));
  const bool has_unit = unit.find_first_not_of("0123456789.-:_+") != unit.npos;
  if (!has_comma && !has_unit) return {};
  std::string written(value.substr(0, end));
  std::string mended = written;
  if (has_comma) mended[comma] = '.';
  if (has_unit) {
    written += fmt::format(" {}", unit);
    mended = fmt::format("\"{} {}\"", mended, unit);
  }
  return fmt::format("'{}': {}{}{}; write {}", written,
                     has_comma ? "a number needs a decimal point, not a comma" : "",
                     has_comma && has_unit ? ", and " : "",
                     has_unit ? "a number with a unit needs quotes" : "", mended);
}

std::string slip_of_value(std::string_view key, std::string_view value) {
  if (value.empty() || value.starts_with('#')) return "there is no value after '='";
  for (const std::string_view curled : {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019"}) {
    if (value.starts_with(curled))
      return "use straight quotes, \"...\", not the curled quotes of a word processor";
  }
  const std::size_t sign = value.starts_with('+') || value.starts_with('-');
  if (value.size() > sign && std::isdigit(static_cast<unsigned char>(value[sign])))
    return slip_of_number(value);
  const bool word = std::isalpha(static_cast<unsigned char>(value.front())) != 0;
  if (!word || value.starts_with("true") || value.starts_with("false")) return {};
  return fmt::format("a text needs quotes: {} = \"...\"", key);
}

}  // namespace

void refuse_long_keys(const std::string& text, const std::string& name) {
  int parts = 1, line = 1;
  for (std::size_t i = 0; i < text.size();) {
    if (const std::size_t length = skipped(text, i)) {
      line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                          text.begin() + static_cast<std::ptrdiff_t>(i + length),
                                          '\n'));
      i += length;
      continue;
    }
    const char c = text[i++];
    if (c == '.') {
      if (++parts > most_parts)
        throw InputError(
            fmt::format("{}:{}: the key has more than {} parts", name, line, most_parts));
    } else if (c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}' || c == '\n') {
      parts = 1;
      if (c == '\n') ++line;
    }
  }
}

std::string common_slip(std::string_view text, std::size_t number_of_line) {
  const std::string_view line = line_of(text, number_of_line);
  if (line.find('=') == line.npos) {
    const std::size_t colon = line.find(':');
    return colon != line.npos && line.find_first_of("[{\"'#") > colon
               ? "write '=' between a key and its value, not ':'"
               : "";
  }
  if (has_open_quote(line)) return "a text is not closed: a quote is missing on this line";
  // The line of an inline table has more than one key.
  std::size_t from = 0;
  for (std::size_t at = line.find('='); at != line.npos; at = line.find('=', at + 1)) {
    const std::string slip =
        slip_of_value(trimmed(line.substr(from, at - from)), trimmed(line.substr(at + 1)));
    if (!slip.empty()) return slip;
    from = std::min(line.find_first_of("{,", at), line.size() - 1) + 1;
  }
  return {};
}

std::string in_our_words(std::string_view description) {
  const std::string_view twice = "cannot redefine existing ";
  const std::size_t at = description.find(twice);
  if (at != description.npos && !description.ends_with("as table")) {
    return fmt::format("{} is defined twice; define each [table], and each key in it, once",
                       description.substr(at + twice.size()));
  }
  const std::size_t colon = description.find(": ");
  const bool parsing = description.starts_with("Error while parsing ") && colon != description.npos;
  return std::string(parsing ? description.substr(colon + 2) : description);
}

}  // namespace wearwell
