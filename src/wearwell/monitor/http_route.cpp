#include "wearwell/monitor/http_route.h"

#include "wearwell/http/settings.h"

namespace wearwell::monitor {
namespace {

constexpr std::string_view unit_prefix = "/api/v1/units/", events_suffix = "/events";

constexpr HttpRoute all_routes[] = {
    {"/", "GET, HEAD", role_read},
    {"/api/v1/fits", "GET, HEAD", role_read, true},
    {"/api/v1/fleet", "GET, HEAD", role_read, true},
    {"/api/v1/units", "GET, HEAD", role_read, true},
    {"/api/v1/units/{name}/events", "POST", role_operate},
    {"/api/v1/units/{name}", "GET, HEAD", role_read, true},
    {"/api/v1/events", "GET", role_read, true},
    {"/api/v1/readings", "POST", role_write},
    {"/api/v1/openapi.json", "GET, HEAD", role_read},
    {"/metrics", "GET, HEAD", role_read, true},
    {"/health", "GET, HEAD", 0},
    {"/login", "GET, HEAD, POST", 0},
    {"/logout", "POST", role_all},
};

}  // namespace

std::span<const HttpRoute> http_routes() {
  return all_routes;
}

bool is_events_of_unit(std::string_view path) {
  return path.starts_with(unit_prefix) && path.ends_with(events_suffix) &&
         path.size() > unit_prefix.size() + events_suffix.size();
}

const HttpRoute* route_of(std::string_view path) {
  const bool events = is_events_of_unit(path);
  const bool unit = !events && path.starts_with(unit_prefix);
  const std::string_view pattern = events ? "/api/v1/units/{name}/events"
                                   : unit ? "/api/v1/units/{name}"
                                          : path;
  for (const HttpRoute& each : all_routes) {
    if (each.path == pattern) return &each;
  }
  return nullptr;
}

std::string unit_in(std::string_view path) {
  path.remove_prefix(unit_prefix.size());
  if (path.ends_with(events_suffix) && path.size() > events_suffix.size())
    path.remove_suffix(events_suffix.size());
  return std::string(path);
}

}  // namespace wearwell::monitor
