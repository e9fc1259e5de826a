#pragma once

#include <map>
#include <string>
#include <string_view>

namespace wearwell {

/// "/api/v1/units?search=J%207&count=20", parsed.
struct HttpTarget {
  std::string path;                          ///< as received, with percent signs
  std::map<std::string, std::string> query;  ///< decoded

  /// A whole number in the query, `otherwise` if it is missing. Throws InputError beyond `most` and
  /// for other texts.
  std::size_t number(const std::string& key, std::size_t otherwise, std::size_t most) const;
};

/// Throws InputError for an invalid path, a repeated key, and invalid percent-encoded UTF-8.
HttpTarget http_target(std::string_view target);

/// "J%207" -> "J 7". `form`: a plus sign is a space. Throws InputError for "%zz" and for invalid
/// UTF-8.
std::string percent_decoded(std::string_view text, bool form = false);

/// "a=1&b=2", decoded.
std::map<std::string, std::string> form_fields(std::string_view text);

}  // namespace wearwell
