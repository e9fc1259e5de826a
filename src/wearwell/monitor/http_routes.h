#pragma once

#include <optional>
#include <string>

#include "wearwell/http/handler.h"
#include "wearwell/http/served_page.h"
#include "wearwell/http/target.h"
#include "wearwell/monitor/fleet_metrics.h"
#include "wearwell/monitor/fleet_page.h"
#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/http_access.h"
#include "wearwell/monitor/http_route.h"

namespace wearwell::monitor {

/// The routes and their answers (docs/reference/monitor-api.md). Any thread may ask.
class HttpRoutes final : public HttpHandler {
 public:
  /// `readings`, `events`: null if these are not accepted by HTTP.
  HttpRoutes(const HttpAccess& access, const FleetReader& reader, Inbox* readings, Inbox* events);

  /// The header is enough to refuse a request: sender, path and method, type of body.
  std::optional<HttpResponse> refuse(const HttpRequest& question) const override;
  /// Whether the request is for the stream of events.
  bool is_events(const HttpRequest& question) const override;
  /// Whether the request is one of supervision, /health or /metrics: answered when others wait.
  bool is_supervision(const HttpRequest& question) const override;
  /// Whether the answer waits for the store.
  bool is_delivery(const HttpRequest& question) const override;

  HttpResponse answer(const HttpRequest& question, const HttpCounts& http) const override;

  /// An event with the changes since `version`, which ends with an empty line; with everything if
  /// there is no version. `*reached`: the version after it.
  std::uint64_t version() const override { return reader_.version(); }
  std::string event(std::optional<std::uint64_t> version, std::uint64_t* reached) const override;
  std::string beat() const override;
  /// The version in `Last-Event-ID`, if it belongs to this run of the monitor.
  std::optional<std::uint64_t> version_of(const std::string& event_id) const override;

 private:
  HttpResponse page(const HttpRequest& question) const;
  HttpResponse login(const HttpRequest& question) const;
  HttpResponse units(const HttpTarget& target) const;
  HttpResponse fits(const HttpTarget& target) const;
  HttpResponse unit(const std::string& encoded) const;
  HttpResponse readings(const HttpRequest& question) const;
  /// Why events among the readings of a sender are refused; empty if they are not.
  std::string no_events(const HttpRequest& question) const;
  HttpResponse event_of_unit(const std::string& encoded, const std::string& body) const;
  HttpResponse metrics(const HttpCounts& http) const;

  const HttpAccess& access_;
  const FleetReader& reader_;
  Inbox *inbox_, *events_;
  ServedPage page_, login_, wrong_;
  std::int64_t started_ms_;
};

}  // namespace wearwell::monitor
