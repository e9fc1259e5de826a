#include "wearwell/monitor/http_server.h"

#include <functional>
#include <optional>

#include "wearwell/http/listener.h"
#include "wearwell/http/tls.h"
#include "wearwell/monitor/http_routes.h"

namespace wearwell::monitor {

struct HttpServer::State {
  State(const HttpSettings& settings, const FleetReader& reader, Inbox* readings, Inbox* events)
      : tls(tls_of(settings)),
        access(settings, tls ? [this](const std::string& name) { return tls->covers(name); }
                             : std::function<bool(const std::string&)>()),
        routes(access, reader, readings, events),
        listener(settings, tls, routes) {}

  std::optional<HttpTls> tls;
  HttpAccess access;
  HttpRoutes routes;
  HttpListener listener;
};

HttpServer::HttpServer(const HttpSettings& settings, const FleetReader& reader, Inbox* readings,
                       Inbox* events)
    : state_(std::make_unique<State>(settings, reader, readings, events)) {}

HttpServer::~HttpServer() = default;

unsigned short HttpServer::port() const {
  return state_->listener.port();
}

std::string HttpServer::address() const {
  return state_->listener.address();
}

void HttpServer::stop() {
  state_->listener.stop();
}

}  // namespace wearwell::monitor
