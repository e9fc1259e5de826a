#pragma once

#include <filesystem>
#include <string>

namespace wearwell::monitor {

/// Where the page and its API are served. Beyond loopback a token, and a certificate with its key, are needed;
/// the configuration is refused without (monitor_config.h).
struct HttpSettings {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::string token = {};                            ///< empty: none is asked for
  std::filesystem::path certificate = {}, key = {};  ///< PEM; empty: no TLS
};

}  // namespace wearwell::monitor
