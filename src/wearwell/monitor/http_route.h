#pragma once

#include <span>
#include <string>
#include <string_view>

namespace wearwell::monitor {

/// A path of the server, "/api/v1/units/{name}", its methods, "GET, HEAD", and the role that it
/// needs (HttpRole; role_all: any; 0: none).
/// `from_states`: its answers come from the states of the units.
struct HttpRoute {
  std::string_view path, methods;
  unsigned role;
  bool from_states = false;
};

/// All paths of the server; openapi.json describes them.
std::span<const HttpRoute> http_routes();

/// The route of a path; null if there is none.
const HttpRoute* route_of(std::string_view path);

/// "/api/v1/units/NAME/events"; a slash of a name is encoded.
bool is_events_of_unit(std::string_view path);
/// "NAME" in this, or in "/api/v1/units/NAME".
std::string unit_in(std::string_view path);

}  // namespace wearwell::monitor
