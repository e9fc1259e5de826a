#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "wearwell/http/message.h"

namespace wearwell {

/// A listener's statistics of itself.
struct HttpCounts {
  std::uint64_t connections = 0, streams = 0;      ///< open now
  std::map<unsigned, std::uint64_t> answers = {};  ///< so far, by status
};

/// What an HttpListener serves: routes, answers and one stream of events. Several threads ask at
/// the same time; `refuse`, the kinds of a request, and `version_of` must not wait.
class HttpHandler {
 public:
  virtual ~HttpHandler() = default;

  /// The header is enough to refuse a request: sender, path and method, type of body.
  virtual std::optional<HttpResponse> refuse(const HttpRequest& question) const = 0;
  /// Whether the request is for the stream of events.
  virtual bool is_events(const HttpRequest& question) const = 0;
  /// Whether the request is answered when others wait for a connection.
  virtual bool is_supervision(const HttpRequest& question) const = 0;
  /// Whether the answer waits for a store.
  virtual bool is_delivery(const HttpRequest& question) const = 0;

  virtual HttpResponse answer(const HttpRequest& question, const HttpCounts& counts) const = 0;

  /// Increases with each change that a stream of events reports.
  virtual std::uint64_t version() const = 0;
  /// An event with the changes since `version`, which ends with an empty line; with everything if
  /// there is no version. `*reached`: the version after it.
  virtual std::string event(std::optional<std::uint64_t> version, std::uint64_t* reached) const = 0;
  /// Sent to a stream without news.
  virtual std::string beat() const = 0;
  /// The version in `Last-Event-ID`, if it belongs to this run of the server.
  virtual std::optional<std::uint64_t> version_of(const std::string& event_id) const = 0;

 protected:
  HttpHandler() = default;
  HttpHandler(const HttpHandler&) = default;
  HttpHandler& operator=(const HttpHandler&) = default;
};

}  // namespace wearwell
