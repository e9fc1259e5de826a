#pragma once

#include <memory>
#include <string>

#include "wearwell/monitor/fleet_view.h"
#include "wearwell/monitor/http_settings.h"

namespace wearwell::monitor {

/// The page, the JSON API, events and metrics of a fleet (docs/reference/monitor-api.md), on threads of its own: one
/// that moves bytes and never waits, two that ask the reader, two that hand to the inbox. What a client is
/// slow to take or to send costs others nothing: a stream of events holds one event, and the next tells all
/// that changed since.
class HttpServer {
 public:
  /// Listens when it returns. `inbox`: null where readings are not taken by HTTP. Reader and inbox outlive it.
  /// Throws InputError for settings that cannot be (beyond loopback without token or TLS, a certificate that
  /// does not fit its key, no such address), MachineError where the port cannot be had.
  HttpServer(const HttpSettings& settings, const FleetReader& reader, Inbox* inbox);
  /// Stops.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  unsigned short port() const;
  /// "https://machine:8443/".
  std::string address() const;
  /// Closes all connections and waits for its threads: at once, but for a reader or an inbox that is being
  /// asked.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wearwell::monitor
