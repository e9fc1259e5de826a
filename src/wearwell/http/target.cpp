#include "wearwell/http/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

int hexadecimal_digit(char hexadecimal) {
  if (hexadecimal >= '0' && hexadecimal <= '9') return hexadecimal - '0';
  if (hexadecimal >= 'a' && hexadecimal <= 'f') return hexadecimal - 'a' + 10;
  if (hexadecimal >= 'A' && hexadecimal <= 'F') return hexadecimal - 'A' + 10;
  return -1;
}

std::string target_text(std::string_view text) {
  return printable(shortened(std::string(text)));
}

}  // namespace

std::string percent_decoded(std::string_view text, bool form) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (form && text[i] == '+') {
      out += ' ';
    } else if (text[i] != '%') {
      out += text[i];
    } else {
      const int high = i + 2 < text.size() ? hexadecimal_digit(text[i + 1]) : -1;
      const int low = i + 2 < text.size() ? hexadecimal_digit(text[i + 2]) : -1;
      if (high < 0 || low < 0) {
        throw InputError(
            fmt::format("\"{}\": two hexadecimal digits must follow %", target_text(text)));
      }
      out += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  if (valid_utf8(out) != out)
    throw InputError(fmt::format("\"{}\" is not UTF-8", target_text(text)));
  return out;
}

std::map<std::string, std::string> form_fields(std::string_view text) {
  std::map<std::string, std::string> fields;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('&'), text.size());
    const std::string_view field = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (field.empty()) continue;
    const std::size_t equals = std::min(field.find('='), field.size());
    const std::string key = percent_decoded(field.substr(0, equals), true);
    const std::string_view value = field.substr(std::min(equals + 1, field.size()));
    if (!fields.try_emplace(key, percent_decoded(value, true)).second) {
      throw InputError(fmt::format("{} occurs twice", target_text(key)));
    }
  }
  return fields;
}

HttpTarget http_target(std::string_view target) {
  if (!target.starts_with('/')) {
    throw InputError(
        fmt::format("\"{}\" is not a path: a path begins with /", target_text(target)));
  }
  const std::size_t end = std::min(target.find('?'), target.size());
  const std::string_view query = target.substr(std::min(end + 1, target.size()));
  return {std::string(target.substr(0, end)), form_fields(query)};
}

std::size_t HttpTarget::number(const std::string& key, std::size_t otherwise,
                               std::size_t most) const {
  const auto at = query.find(key);
  if (at == query.end()) return otherwise;
  const std::string& text = at->second;
  std::size_t value = 0;
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || last != text.data() + text.size() || value > most) {
    throw InputError(fmt::format("{} = \"{}\": must be a whole number from 0 to {}", key,
                                 target_text(text), most));
  }
  return value;
}

}  // namespace wearwell
