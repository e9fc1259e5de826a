#pragma once

#include <string>
#include <utility>
#include <vector>

namespace wearwell {

/// The parts of a request that answers depend on. Missing fields are "".
struct HttpRequest {
  std::string method, target;  ///< "GET", "/api/v1/units?count=20"
  std::string host, origin, fetch_site, authorization, cookie, content_type, content_encoding;
  std::string last_event_id, if_none_match;
  std::string body;
};

struct HttpResponse {
  unsigned status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::vector<std::pair<std::string, std::string>> fields = {};  ///< further ones
};

/// {"error": "..."}: the error, in one sentence.
HttpResponse refusal(unsigned status, const std::string& problem);

}  // namespace wearwell
