#pragma once

#include <memory>
#include <string>

#include "wearwell/http/settings.h"
#include "wearwell/monitor/fleet_view.h"

namespace wearwell::monitor {

/// The page, the JSON API, events and metrics of a fleet (docs/reference/monitor-api.md), served by
/// an HttpListener: two of its threads query the reader, two pass messages to the inbox.
class HttpServer {
 public:
  /// Listening when it returns. `readings`, `events`: null if these are not accepted by HTTP. All
  /// must outlive it. Throws InputError for invalid settings (beyond loopback without token
  /// or TLS, a certificate that does not match its key, an unknown address), MachineError if the
  /// port is not available.
  HttpServer(const HttpSettings& settings, const FleetReader& reader, Inbox* readings,
             Inbox* events = nullptr);
  /// Stops.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  unsigned short port() const;
  /// "https://machine:8443/".
  std::string address() const;
  /// Closes all connections and waits for its threads: immediate, unless a reader or an inbox is
  /// busy.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wearwell::monitor
