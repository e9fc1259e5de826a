#include "wearwell/fleet/http_post.h"

#include <fmt/format.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <chrono>
#include <optional>

namespace wearwell::fleet {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
using net::ip::tcp;
using Error = beast::error_code;
using Clock = std::chrono::steady_clock;
using Plain = beast::tcp_stream;
using TlsStream = beast::ssl_stream<beast::tcp_stream>;

constexpr double connect_seconds = 10;
constexpr auto between_waits = std::chrono::milliseconds(100);

/// Runs one operation after the other, each to its end.
class Driver {
 public:
  explicit Driver(const HttpRequest& request) : request_(request), start_(Clock::now()) {}

  net::io_context io{1};

  /// `start` begins an operation with the given handler; `cancel` ends it early. `seconds`: 0 for
  /// the request's limit only.
  template <class Start, class Cancel>
  Error run(const Start& start, const Cancel& cancel, double seconds = 0) {
    std::optional<Error> outcome;
    const auto begin = Clock::now();
    start([&](Error error, auto&&...) { outcome = error; });
    try {
      while (!outcome) {
        io.restart();
        io.run_one_for(between_waits);
        const auto now = Clock::now();
        if (now - waited_ >= between_waits) {
          waited_ = now;
          if (request_.wait) request_.wait();
        }
        check(seconds, begin);
        check(request_.seconds, start_);
      }
    } catch (...) {
      cancel();
      while (!outcome) {
        io.restart();
        io.run_one();
      }
      throw;
    }
    return *outcome;
  }

 private:
  static void check(double seconds, Clock::time_point since) {
    if (seconds > 0 && Clock::now() - since > std::chrono::duration<double>(seconds))
      throw HttpBroken(fmt::format("no answer within {:g} s", seconds));
  }

  const HttpRequest& request_;
  Clock::time_point start_, waited_ = Clock::now();
};

void demand(Error error) {
  if (!error) return;
  if (error == http::error::end_of_stream || error == http::error::partial_message ||
      error == net::error::eof || error == net::ssl::error::stream_truncated)
    throw HttpBroken("the connection was closed before the end of the answer");
  throw HttpBroken(error.message());
}

void connect(Driver& driver, Plain& stream, const HttpPlace& place) {
  tcp::resolver resolver(driver.io);
  tcp::resolver::results_type found;
  demand(driver.run(
      [&](auto done) {
        resolver.async_resolve(place.host, place.port, [&found, done](Error error, auto results) {
          found = results;
          done(error);
        });
      },
      [&] { resolver.cancel(); }, connect_seconds));
  demand(driver.run(
      [&](auto done) {
        stream.async_connect(found, [done](Error error, const tcp::endpoint&) { done(error); });
      },
      [&] { stream.close(); }, connect_seconds));
  // A request is one write followed by waiting: no need to coalesce packets.
  stream.socket().set_option(tcp::no_delay(true));
  stream.socket().set_option(net::socket_base::keep_alive(true));
}

/// RFC 9110, 7.2: with the port unless it is the scheme's own; an IPv6 address in brackets.
std::string host_field(const HttpPlace& place) {
  const bool six = place.host.find(':') != std::string::npos && !place.host.starts_with('[');
  const std::string host = six ? "[" + place.host + "]" : place.host;
  return place.port == (place.tls ? "443" : "80") ? host : host + ":" + place.port;
}

template <class Stream>
void exchange(Driver& driver, Stream& stream, const HttpPlace& place, const HttpRequest& request,
              const std::function<void(int, std::string_view)>& take) {
  const auto cancel = [&] { beast::get_lowest_layer(stream).close(); };
  http::request<http::string_body> message(http::verb::post, request.target, 11);
  message.set(http::field::host, host_field(place));
  message.set(http::field::connection, "close");
  for (const auto& [name, value] : request.fields) message.set(name, value);
  message.body() = request.body;
  message.prepare_payload();
  demand(driver.run([&](auto done) { http::async_write(stream, message, done); }, cancel));

  constexpr std::uint32_t most_header = 1 << 16;
  beast::flat_buffer buffer;
  http::response_parser<http::buffer_body> parser;
  parser.header_limit(most_header);
  parser.body_limit(boost::none);
  demand(driver.run([&](auto done) { http::async_read_header(stream, buffer, parser, done); },
                    cancel));
  if (parser.is_done()) take(parser.get().result_int(), {});  // no body, but a status
  std::array<char, 1 << 16> piece;
  while (!parser.is_done()) {
    parser.get().body().data = piece.data();
    parser.get().body().size = piece.size();
    const Error error =
        driver.run([&](auto done) { http::async_read(stream, buffer, parser, done); }, cancel);
    if (error != http::error::need_buffer) demand(error);
    take(parser.get().result_int(), {piece.data(), piece.size() - parser.get().body().size});
  }
}

}  // namespace

void http_post(const HttpPlace& place, const HttpRequest& request,
               const std::function<void(int, std::string_view)>& take) {
  Driver driver(request);
  if (!place.tls) {
    Plain stream(driver.io);
    connect(driver, stream, place);
    exchange(driver, stream, place, request, take);
    return;
  }
  net::ssl::context context(net::ssl::context::tls_client);
  context.set_options(net::ssl::context::no_tlsv1 | net::ssl::context::no_tlsv1_1);
  context.set_default_verify_paths();
  context.set_verify_mode(net::ssl::verify_peer);
  context.set_verify_callback(net::ssl::host_name_verification(place.host));
  TlsStream stream(driver.io, context);
  Error bad_address;
  net::ip::make_address(place.host, bad_address);
  // SNI for servers with several names; an address is not a name.
  if (bad_address && !SSL_set_tlsext_host_name(stream.native_handle(), place.host.c_str()))
    throw HttpBroken("OpenSSL does not accept this host name");
  Plain& tcp = beast::get_lowest_layer(stream);
  connect(driver, tcp, place);
  demand(driver.run([&](auto done) { stream.async_handshake(net::ssl::stream_base::client, done); },
                    [&] { tcp.close(); }, connect_seconds));
  exchange(driver, stream, place, request, take);
}

}  // namespace wearwell::fleet
