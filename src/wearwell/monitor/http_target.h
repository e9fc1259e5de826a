#pragma once

#include <map>
#include <string>
#include <string_view>

namespace wearwell::monitor {

/// "/api/units?search=J%207&count=20" taken apart.
struct HttpTarget {
  std::string path;                          ///< as it stands, percent signs and all
  std::map<std::string, std::string> query;  ///< decoded

  /// A whole number of the query, `otherwise` where it does not stand there. Throws InputError beyond `most`
  /// and for what is no number.
  std::size_t number(const std::string& key, std::size_t otherwise, std::size_t most) const;
};

/// Throws InputError for what is no path of this server's kind, for a key that stands twice, and for what is
/// not percent-encoded UTF-8.
HttpTarget http_target(std::string_view target);

/// "J%207" -> "J 7". `form`: a plus sign is a space. Throws InputError for "%zz" and for what is not UTF-8.
std::string percent_decoded(std::string_view text, bool form = false);

/// "a=1&b=2", decoded.
std::map<std::string, std::string> form_fields(std::string_view text);

}  // namespace wearwell::monitor
