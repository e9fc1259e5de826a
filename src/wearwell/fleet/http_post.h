#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wearwell::fleet {

/// An HTTP server.
struct HttpPlace {
  std::string host, port;
  bool tls =
      /// its certificate is verified against this machine's authorities (or SSL_CERT_FILE) and the
      /// host name
      false;
};

/// No complete answer: nothing listens, no connection, no trusted certificate, or truncated.
struct HttpBroken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct HttpRequest {
  std::string target;  ///< "/?query_id=1"
  std::vector<std::pair<std::string, std::string>> fields = {};
  std::string body = {};
  double seconds = 0;  ///< for all of it; 0: no limit except `wait`
  /// Called ten times a second; an exception ends the exchange. May be empty.
  std::function<void()> wait = {};
};

/// Sends a request on its own connection and passes on the pieces of the answer as they arrive,
/// with its status; without a body one empty piece. Throws HttpBroken, perhaps after some pieces, and exceptions of `wait` and
/// `take`.
void http_post(const HttpPlace& place, const HttpRequest& request,
               const std::function<void(int status, std::string_view piece)>& take);

}  // namespace wearwell::fleet
