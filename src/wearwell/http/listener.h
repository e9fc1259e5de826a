#pragma once

#include <memory>
#include <optional>
#include <string>

#include "wearwell/http/handler.h"
#include "wearwell/http/settings.h"
#include "wearwell/http/tls.h"

namespace wearwell {

/// Listens, and answers what a handler answers, on its own threads: one that moves bytes and never
/// waits, two for answers, two for answers that wait for a store. A slow client does not affect
/// others: a stream of events holds one event, and the next contains all changes since.
class HttpListener {
 public:
  /// Listening when it returns. `handler` must outlive it. Throws InputError for invalid settings
  /// (beyond loopback without token or TLS, an unknown address), MachineError if the port is not
  /// available.
  HttpListener(const HttpSettings& settings, const std::optional<HttpTls>& tls,
               const HttpHandler& handler);
  /// Stops.
  ~HttpListener();
  HttpListener(const HttpListener&) = delete;
  HttpListener& operator=(const HttpListener&) = delete;

  unsigned short port() const;
  /// "https://machine:8443/".
  std::string address() const;
  /// Closes all connections and waits for its threads: immediate, unless an answer is being made.
  void stop();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wearwell
