#pragma once

#include <optional>
#include <string>

#include "wearwell/monitor/fleet_metrics.h"
#include "wearwell/monitor/fleet_page.h"
#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/http_access.h"
#include "wearwell/monitor/http_message.h"
#include "wearwell/monitor/http_target.h"

namespace wearwell::monitor {

/// Which path is answered how (docs/reference/monitor-api.md). Any thread may ask.
class HttpRoutes {
 public:
  /// `inbox`: null where readings are not taken by HTTP.
  HttpRoutes(const HttpAccess& access, const FleetReader& reader, Inbox* inbox);

  /// What stands in the header is enough to refuse it: who asks, which path and method, what kind of body.
  std::optional<HttpResponse> refuse(const HttpRequest& question) const;
  /// Whether what is asked for is the stream of events.
  static bool is_events(const HttpRequest& question);
  /// Whether the answer waits for the store.
  static bool is_delivery(const HttpRequest& question);

  HttpResponse answer(const HttpRequest& question, const HttpCounts& http) const;

  /// An event of what changed since `version`, that ends with an empty line; of all where there is none.
  /// `*reached`: the version that it leads to.
  std::string event(std::optional<std::uint64_t> version, std::uint64_t* reached) const;
  std::string beat() const;
  /// The version that `Last-Event-ID` names, when it is one of this run of the monitor.
  std::optional<std::uint64_t> version_of(const std::string& event_id) const;

 private:
  HttpResponse page(const HttpRequest& question) const;
  HttpResponse login(const HttpRequest& question) const;
  HttpResponse units(const HttpTarget& target) const;
  HttpResponse unit(const std::string& encoded) const;
  HttpResponse readings(const std::string& body) const;
  HttpResponse metrics(const HttpCounts& http) const;

  const HttpAccess& access_;
  const FleetReader& reader_;
  Inbox* inbox_;
  ServedPage page_, login_, wrong_;
  std::int64_t started_ms_;
};

}  // namespace wearwell::monitor
