#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace wearwell {

/// Limits for one client, and for all together. Requests beyond them are answered with 413, 431 or
/// 503, or cut off.
struct HttpLimits {
  std::size_t header_bytes = 8 * 1024;       ///< of a request line and all its fields
  std::size_t body_bytes = 4 * 1024 * 1024;  ///< of one request with readings
  std::size_t large_bodies = 32;  ///< of more than 64 KiB, or of unknown length, at the same time
  std::size_t connections = 256;  ///< open at the same time
  std::size_t of_client = 64;     ///< of these, of one address (IPv6: of one /64 network)
  /// Connections beyond both, for /health and /metrics alone. If these are all in use, the one that
  /// has waited longest without a request ends for a new one.
  std::size_t reserve = 16;
  std::size_t streams = 64;                         ///< of these, listening to events
  std::size_t streams_of_client = 16;               ///< of these, of one address
  std::chrono::milliseconds header{10'000};         ///< for a whole header, or between two requests
  std::chrono::milliseconds reserve_header{2'000};  ///< the same on a connection of the reserve
  std::chrono::milliseconds body{30'000};           ///< for a whole body
  std::chrono::milliseconds write{20'000};  ///< for a client to receive an answer or an event
  std::chrono::milliseconds between{500};   ///< minimum time between two events of a stream
  std::chrono::milliseconds beat{10'000};   ///< interval of beats on a stream without news
};

/// What a token may do: to read, to send readings, to report events and acknowledge alarms.
enum HttpRole : unsigned { role_read = 1, role_write = 2, role_operate = 4, role_all = 7 };

/// A token with its own roles.
struct HttpToken {
  std::string name, token;
  unsigned roles = 0;  ///< of HttpRole
};

/// Address and access rules of the server.
struct HttpSettings {
  std::string host = "127.0.0.1";                    ///< an address, or a name of this machine
  int port = 8080;                                   ///< 0: any free port
  std::string token = {};                            ///< clients must know it; "": no token needed
  std::vector<HttpToken> tokens = {};                ///< further ones
  std::filesystem::path certificate = {}, key = {};  ///< PEM, for TLS; both or none
  /// Further names of the server: of a proxy, or of this machine. Names in the certificate are
  /// included.
  std::vector<std::string> names = {};
  bool events = true;  ///< whether events of units are accepted
  HttpLimits limits = {};

  bool needs_token() const { return !token.empty() || !tokens.empty(); }
};

}  // namespace wearwell
