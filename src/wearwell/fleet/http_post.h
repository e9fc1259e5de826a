#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wearwell::fleet {

/// A server that speaks HTTP.
struct HttpPlace {
  std::string host, port;
  bool tls =
      false;  ///< its certificate is held against this machine's (or SSL_CERT_FILE) and the host's name
};

/// No answer, or not all of one: nobody listens, no connection, no certificate that can be trusted, cut off.
struct HttpBroken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct HttpRequest {
  std::string target;  ///< "/?query_id=1"
  std::vector<std::pair<std::string, std::string>> fields = {};
  std::string body = {};
  double seconds = 0;  ///< for all of it; 0: as long as `wait` lets it
  /// Called ten times a second; what it throws ends the exchange. May be empty.
  std::function<void()> wait = {};
};

/// Sends a request on a connection of its own and hands on the pieces of the answer as they come, with its status. Throws HttpBroken,
/// after some pieces perhaps, and whatever `wait` or `take` throws.
void http_post(const HttpPlace& place, const HttpRequest& request,
               const std::function<void(int status, std::string_view piece)>& take);

}  // namespace wearwell::fleet
