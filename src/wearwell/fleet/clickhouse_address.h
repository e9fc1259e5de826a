#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/http_post.h"

namespace wearwell::fleet {

/// "clickhouse://USER:PASSWORD@HOST:PORT,HOST:PORT/DATABASE" taken apart.
struct ClickhouseAddress {
  std::string user = "default", password = {}, database = "default";
  std::vector<HttpPlace> hosts;  ///< replicas of each other
};
/// Signs that mean something in an address are written as "%40" in names and passwords. Throws InputError, which
/// does not show the password.
ClickhouseAddress read_clickhouse_address(const std::string& text);

/// A text as a part of a URL: "a%20b".
std::string url_part(const std::string& text);

}  // namespace wearwell::fleet
