#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/http_post.h"

namespace wearwell::fleet {

/// "clickhouse://USER:PASSWORD@HOST:PORT,HOST:PORT/DATABASE", parsed.
struct ClickhouseAddress {
  std::string user = "default", password = {}, database = "default";
  std::vector<HttpPlace> hosts;  ///< replicas of each other
};
/// Reserved characters in names and passwords are written like "%40". Throws InputError, which does
/// not show the password.
ClickhouseAddress read_clickhouse_address(const std::string& text);

/// A text encoded for a URL: "a%20b".
std::string url_part(const std::string& text);

}  // namespace wearwell::fleet
