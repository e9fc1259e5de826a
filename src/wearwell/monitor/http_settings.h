#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace wearwell::monitor {

/// What one client, and all together, may ask of the server. What goes beyond is answered with 413, 431 or
/// 503, or cut off.
struct HttpLimits {
  std::size_t header_bytes = 8 * 1024;       ///< of a request line and all its fields
  std::size_t body_bytes = 4 * 1024 * 1024;  ///< of readings posted at once
  std::size_t large_bodies = 32;  ///< of more than 64 KiB, or of unknown length, at one time
  std::size_t connections = 256;  ///< open at one time
  std::size_t streams = 64;       ///< of these, listening to events
  std::chrono::milliseconds header{10'000};  ///< for a whole header, or between two requests
  std::chrono::milliseconds body{30'000};    ///< for a whole body
  std::chrono::milliseconds write{20'000};   ///< for a client to take an answer or an event
  std::chrono::milliseconds between{500};    ///< two events that a stream gets
  std::chrono::milliseconds beat{10'000};    ///< a stream without news gets a beat so often
};

/// Where the server listens, and whom it answers.
struct HttpSettings {
  std::string host = "127.0.0.1";  ///< an address, or a name of this machine
  int port = 8080;                 ///< 0: any that is free
  std::string token = {};          ///< whoever asks must know it; "": nobody has to
  std::filesystem::path certificate = {}, key = {};  ///< PEM, for TLS; both or none
  /// Under which other names people reach it: of a proxy, or of this machine. Names of the certificate need
  /// not be said.
  std::vector<std::string> names = {};
  HttpLimits limits = {};
};

}  // namespace wearwell::monitor
