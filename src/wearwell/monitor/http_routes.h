#pragma once

#include <optional>
#include <string>

#include "wearwell/monitor/fleet_metrics.h"
#include "wearwell/monitor/fleet_page.h"
#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/http_access.h"
#include "wearwell/monitor/http_message.h"
#include "wearwell/monitor/http_route.h"
#include "wearwell/monitor/http_target.h"

namespace wearwell::monitor {

/// The routes and their answers (docs/reference/monitor-api.md). Any thread may ask.
class HttpRoutes {
 public:
  /// `readings`, `events`: null if these are not accepted by HTTP.
  HttpRoutes(const HttpAccess& access, const FleetReader& reader, Inbox* readings, Inbox* events);

  /// The header is enough to refuse a request: sender, path and method, type of body.
  std::optional<HttpResponse> refuse(const HttpRequest& question) const;
  /// Whether the request is for the stream of events.
  static bool is_events(const HttpRequest& question);
  /// Whether the request is one of supervision, /health or /metrics: answered when others wait.
  static bool is_supervision(const HttpRequest& question);
  /// Whether the answer waits for the store.
  static bool is_delivery(const HttpRequest& question);

  HttpResponse answer(const HttpRequest& question, const HttpCounts& http) const;

  /// An event with the changes since `version`, which ends with an empty line; with everything if
  /// there is no version. `*reached`: the version after it.
  std::string event(std::optional<std::uint64_t> version, std::uint64_t* reached) const;
  std::string beat() const;
  /// The version in `Last-Event-ID`, if it belongs to this run of the monitor.
  std::optional<std::uint64_t> version_of(const std::string& event_id) const;

 private:
  HttpResponse page(const HttpRequest& question) const;
  HttpResponse login(const HttpRequest& question) const;
  HttpResponse units(const HttpTarget& target) const;
  HttpResponse fits(const HttpTarget& target) const;
  HttpResponse unit(const std::string& encoded) const;
  HttpResponse readings(const std::string& body) const;
  HttpResponse event_of_unit(const std::string& encoded, const std::string& body) const;
  HttpResponse metrics(const HttpCounts& http) const;

  const HttpAccess& access_;
  const FleetReader& reader_;
  Inbox *inbox_, *events_;
  ServedPage page_, login_, wrong_;
  std::int64_t started_ms_;
};

}  // namespace wearwell::monitor
