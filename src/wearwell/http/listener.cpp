#include "wearwell/http/listener.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <map>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/http/connection.h"
#include "wearwell/http/tls.h"

namespace wearwell {
namespace {

namespace net = boost::asio;
using Error = boost::system::error_code;
using Tcp = net::ip::tcp;
using Clock = std::chrono::steady_clock;

Tcp::endpoint endpoint_of(const HttpSettings& settings, net::io_context* io) {
  if (settings.port < 0 || settings.port > 65535) {
    throw InputError(
        fmt::format("port = {}: must be from 0 (any free port) to 65535", settings.port));
  }
  const auto port = static_cast<unsigned short>(settings.port);
  Error error;
  const net::ip::address address = net::ip::make_address(settings.host, error);
  if (!error) return {address, port};
  const auto found = Tcp::resolver(*io).resolve(settings.host, "", error);
  if (error || found.empty()) {
    throw InputError(fmt::format("host = \"{}\" is neither an address nor a known name: {}",
                                 printable(settings.host), error.message()));
  }
  return {found.begin()->endpoint().address(), port};
}

void check_reach(const HttpSettings& settings, const Tcp::endpoint& endpoint) {
  if (endpoint.address().is_loopback()) return;
  std::string missing;
  if (!settings.needs_token()) missing = "a token";
  if (settings.certificate.empty()) {
    missing += missing.empty() ? "" : " and ";
    missing += "TLS (certificate and key)";
  }
  if (missing.empty()) return;
  throw InputError(
      fmt::format("host = \"{}\" is reachable from other machines: set {}; or use 127.0.0.1, which "
                  "only this machine can reach",
                  printable(settings.host), missing));
}

/// What one client can hardly leave: its address, or its network of IPv6.
std::string client_of(const net::ip::address& address) {
  if (!address.is_v6()) return address.to_string();
  const net::ip::address_v6 v6 = address.to_v6();
  if (v6.is_v4_mapped()) return net::ip::make_address_v4(net::ip::v4_mapped, v6).to_string();
  const auto bytes = v6.to_bytes();
  return {bytes.begin(), bytes.begin() + 8};
}

Tcp::acceptor listening(const HttpSettings& settings, const Tcp::endpoint& endpoint,
                        net::io_context* io) {
  Tcp::acceptor acceptor(*io);
  Error error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(net::socket_base::max_listen_connections, error);
  if (error) {
    throw MachineError(fmt::format("cannot listen at {}, port {}: {}", printable(settings.host),
                                   settings.port, error.message()));
  }
  return acceptor;
}

}  // namespace

struct HttpListener::State {
  State(const HttpSettings& settings, const std::optional<HttpTls>& tls, const HttpHandler& of)
      : handler(of), hub(of, settings.limits), acceptor(hub.io), pause(hub.io), tick(hub.io) {
    const Tcp::endpoint endpoint = endpoint_of(settings, &hub.io);
    check_reach(settings, endpoint);
    if (tls) {
      SSL_CTX_up_ref(tls->context());
      hub.tls = std::make_unique<net::ssl::context>(tls->context());
    }
    acceptor = listening(settings, endpoint, &hub.io);
    const bool v6 = endpoint.address().is_v6();
    const std::string host = settings.host.find(':') == std::string::npos || !v6
                                 ? settings.host
                                 : "[" + settings.host + "]";
    port = acceptor.local_endpoint().port();
    address = fmt::format("{}://{}:{}/", tls ? "https" : "http", host, port);
  }

  // A failure of one connection, such as lack of memory, must not end the others.
  void run() {
    for (;;) {
      try {
        hub.io.run();
        return;
      } catch (const std::exception&) {
      }
    }
  }

  void accept() {
    acceptor.async_accept([this](Error error, Tcp::socket socket) {
      if (error == net::error::operation_aborted) return;
      if (error) {  // perhaps no descriptors are left: they become free again
        pause.expires_after(std::chrono::milliseconds(100));
        return pause.async_wait([this](Error stopped) {
          if (!stopped) accept();
        });
      }
      admit(std::move(socket));
      accept();
    });
  }

  void admit(Tcp::socket socket) {
    Error gone;
    const std::string client = client_of(socket.remote_endpoint(gone).address());
    if (gone) return;
    const auto own = hub.of_client.find(client);
    const bool has_room = hub.connections.size() < hub.limits.connections &&
                          (own == hub.of_client.end() || own->second < hub.limits.of_client);
    if (has_room) return make_connection(std::move(socket), client, &hub)->start();
    if (hub.reserve.size() >= hub.limits.reserve) {
      const auto idle = std::find_if(hub.reserve.begin(), hub.reserve.end(),
                                     [](const HttpConnection* each) { return each->idle(); });
      if (idle == hub.reserve.end()) return turn_away(std::move(socket));
      HttpConnection* const ended = *idle;
      hub.reserve.splice(hub.reserve.end(), hub.reserve,
                         idle);  // it leaves when its read has ended
      ended->close();
    }
    make_connection(std::move(socket), "", &hub)->start();
  }

  // If it can be sent without waiting.
  void turn_away(Tcp::socket socket) {
    ++hub.answers[503];
    if (hub.tls) return;
    static constexpr std::string_view full =
        "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nRetry-After: 10\r\nConnection: "
        "close\r\n\r\n";
    Error ignored;
    socket.non_blocking(true, ignored);
    socket.write_some(net::buffer(full), ignored);
    socket.shutdown(Tcp::socket::shutdown_both, ignored);
  }

  void run_ticks() {
    tick.expires_after(hub.limits.between);
    tick.async_wait([this](Error error) {
      if (error) return;
      if (!hub.streams.empty()) {
        make_events();
      } else {
        run_ticks();
      }
    });
  }

  /// One event for all streams at the same version.
  struct Event {
    std::shared_ptr<const std::string> text;
    std::uint64_t reached = 0;
  };
  using Events = std::map<std::optional<std::uint64_t>, Event>;

  void make_events() {
    Events wanted;
    for (const HttpConnection* each : hub.streams) {
      if (each->waits()) wanted[each->version()];
    }
    net::post(hub.readers, [this, wanted = std::move(wanted)]() mutable {
      try {
        const std::uint64_t now = handler.version();
        for (auto& [from, event] : wanted) {
          if (from == now) continue;
          event.text = std::make_shared<std::string>(handler.event(from, &event.reached));
        }
      } catch (const std::exception&) {
        wanted.clear();  // asked again at the next tick
      }
      net::post(hub.io, [this, events = std::move(wanted)] { send_events(events); });
    });
  }

  void send_events(const Events& events) {
    const bool beats = Clock::now() - last_beat >= hub.limits.beat;
    if (beats) last_beat = Clock::now();
    const auto beat = beats ? std::make_shared<const std::string>(handler.beat()) : nullptr;
    const auto streams = hub.streams;  // sending may end some
    for (HttpConnection* each : streams) {
      if (!each->waits()) continue;
      const auto at = events.find(each->version());
      if (at != events.end() && at->second.text) {
        each->send(at->second.text, at->second.reached);
      } else if (beat) {
        each->send(beat, each->version());
      }
    }
    run_ticks();
  }

  const HttpHandler& handler;
  HttpHub hub;
  Tcp::acceptor acceptor;
  net::steady_timer pause, tick;
  Clock::time_point last_beat = Clock::now();
  unsigned short port = 0;
  std::string address;
  std::thread thread;
};

HttpListener::HttpListener(const HttpSettings& settings, const std::optional<HttpTls>& tls,
                           const HttpHandler& handler)
    : state_(std::make_unique<State>(settings, tls, handler)) {
  state_->accept();
  state_->run_ticks();
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

HttpListener::~HttpListener() {
  stop();
}

unsigned short HttpListener::port() const {
  return state_->port;
}

std::string HttpListener::address() const {
  return state_->address;
}

void HttpListener::stop() {
  if (!state_->thread.joinable()) return;
  HttpHub& hub = state_->hub;
  hub.readers.stop();
  hub.deliveries.stop();
  hub.readers.join();
  hub.deliveries.join();
  hub.io.stop();
  state_->thread.join();
  Error ignored;
  state_->acceptor.close(ignored);
  const auto connections = hub.connections;
  for (HttpConnection* each : connections) each->close();
  const auto reserve = hub.reserve;
  for (HttpConnection* each : reserve) each->close();
}

}  // namespace wearwell
