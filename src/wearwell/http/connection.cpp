#include "wearwell/http/connection.h"

#include <fmt/format.h>

#include <array>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <sstream>
#include <type_traits>
#include <utility>

#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
using Error = beast::error_code;
using Plain = beast::tcp_stream;
using TlsStream = beast::ssl_stream<beast::tcp_stream>;

std::string text_of_field(beast::string_view view) {
  return {view.data(), view.size()};
}

HttpRequest question_of(const http::request<http::string_body>& request) {
  const auto field = [&](http::field name) { return text_of_field(request[name]); };
  HttpRequest question;
  question.method = text_of_field(request.method_string());
  question.target = text_of_field(request.target());
  if (request.count(http::field::host) == 1) question.host = field(http::field::host);
  question.origin = field(http::field::origin);
  question.fetch_site = text_of_field(request["Sec-Fetch-Site"]);
  question.authorization = field(http::field::authorization);
  question.cookie = field(http::field::cookie);
  question.content_type = field(http::field::content_type);
  question.content_encoding = field(http::field::content_encoding);
  question.last_event_id = text_of_field(request["Last-Event-ID"]);
  question.if_none_match = field(http::field::if_none_match);
  return question;
}

template <class Message>
void set_common_fields(Message* message, bool tls) {
  message->set(http::field::server, "wearwell");
  message->set(http::field::cache_control, "no-store");
  message->set("X-Content-Type-Options", "nosniff");
  message->set("X-Frame-Options", "DENY");
  message->set("Referrer-Policy", "same-origin");  // without it a form sends no Origin
  message->set("Cross-Origin-Resource-Policy", "same-origin");
  message->set("Cross-Origin-Opener-Policy", "same-origin");
  if (tls) message->set("Strict-Transport-Security", "max-age=31536000");
}

HttpResponse no_room() {
  HttpResponse answer = refusal(503, "too many connections, of this client or of all");
  answer.fields.emplace_back("Retry-After", "10");
  return answer;
}

HttpResponse answer_to_error(const Error& error) {
  if (error == http::error::body_limit) return refusal(413, "the body is too long");
  if (error == http::error::header_limit) return refusal(431, "the header is too long");
  return refusal(400, fmt::format("this is not an HTTP request: {}", error.message()));
}

/// Of the parser's errors, only these mean that the input is not a request.
bool is_of_http(const Error& error) {
  return error.category() == http::make_error_code(http::error::bad_method).category() &&
         error != http::error::end_of_stream && error != http::error::partial_message;
}

template <class Stream>
class Connection final : public HttpConnection,
                         public std::enable_shared_from_this<Connection<Stream>> {
 public:
  template <class... Arguments>
  Connection(HttpHub* hub, const std::string& client, Arguments&&... arguments)
      : hub_(*hub), client_(client), stream_(std::forward<Arguments>(arguments)...) {
    if (is_reserve()) {
      hub_.reserve.push_back(this);
    } else {
      hub_.connections.insert(this);
      ++hub_.of_client[client_];
    }
  }
  ~Connection() override {
    if (is_reserve()) {
      hub_.reserve.remove(this);
    } else {
      hub_.connections.erase(this);
      const auto own = hub_.of_client.find(client_);
      if (--own->second == 0) hub_.of_client.erase(own);
    }
    leave_streams();
    if (large_) --hub_.large_bodies;
  }

  void start() override {
    Error ignored;
    tcp().socket().set_option(net::ip::tcp::no_delay(true), ignored);
    if constexpr (is_tls) {
      tcp().expires_after(header_time());
      stream_.async_handshake(net::ssl::stream_base::server, [self = self()](Error error) {
        if (!error) self->read_header();
      });
    } else {
      read_header();
    }
  }

  void close() override {
    Error ignored;
    tcp().socket().close(ignored);
  }

  bool idle() const override { return idle_; }
  bool waits() const override { return !writing_; }
  std::optional<std::uint64_t> version() const override { return version_; }

  void send(std::shared_ptr<const std::string> event,
            std::optional<std::uint64_t> reached) override {
    writing_ = true;
    event_ = std::move(event);
    tcp().expires_after(hub_.limits.write);  // for writing: the read below waits without a limit
    net::async_write(stream_, net::buffer(*event_),
                     [self = self(), reached](Error error, std::size_t) {
                       self->writing_ = false;
                       self->event_.reset();
                       if (reached) self->version_ = reached;
                       if (error) self->close();
                     });
  }

 private:
  static constexpr bool is_tls = std::is_same_v<Stream, TlsStream>;

  auto self() { return this->shared_from_this(); }
  Plain& tcp() { return beast::get_lowest_layer(stream_); }
  bool is_reserve() const { return client_.empty(); }
  std::chrono::milliseconds header_time() const {
    return is_reserve() ? hub_.limits.reserve_header : hub_.limits.header;
  }

  void read_header() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(hub_.limits.header_bytes));
    parser_->body_limit(hub_.limits.body_bytes);
    tcp().expires_after(header_time());
    idle_ = true;
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = self()](Error error, std::size_t) { self->on_header(error); });
  }

  void on_header(const Error& error) {
    if (error) return fail(error);
    idle_ = false;
    const auto& request = parser_->get();
    question_ = question_of(request);
    if (is_reserve() && !hub_.handler.is_supervision(question_)) return respond(no_room());
    if (auto refused = hub_.handler.refuse(question_)) return respond(std::move(*refused));
    if (hub_.handler.is_events(question_)) return listen();
    if (is_large()) {
      if (hub_.large_bodies >= hub_.limits.large_bodies) {
        HttpResponse answer = refusal(503, "too many large requests at once");
        answer.fields.emplace_back("Retry-After", "5");
        return respond(std::move(answer));
      }
      large_ = true;
      ++hub_.large_bodies;
    }
    if (beast::iequals(request[http::field::expect], "100-continue")) {
      tcp().expires_after(hub_.limits.write);
      static constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
      return net::async_write(stream_, net::buffer(go_on),
                              [self = self()](Error failed, std::size_t) {
                                if (!failed) self->read_body();
                              });
    }
    read_body();
  }

  bool is_large() const {
    constexpr std::uint64_t large = 64 * 1024;
    const auto length = parser_->content_length();
    return !parser_->is_done() && (!length || *length > large);
  }

  void read_body() {
    tcp().expires_after(hub_.limits.body);
    http::async_read(stream_, buffer_, *parser_, [self = self()](Error error, std::size_t) {
      if (error) return self->fail(error);
      self->question_.body = std::move(self->parser_->get().body());
      self->ask();
    });
  }

  // On a thread that may wait; the answer returns to this one.
  void ask() {
    auto& pool = hub_.handler.is_delivery(question_) ? hub_.deliveries : hub_.readers;
    HttpCounts counts{hub_.connections.size(), hub_.streams.size(), hub_.answers};
    net::post(pool, [self = self(), counts = std::move(counts)]() mutable {
      HttpResponse answer = self->hub_.handler.answer(self->question_, counts);
      auto& io = self->hub_.io;
      net::post(io, [self = std::move(self), answer = std::move(answer)]() mutable {
        self->respond(std::move(answer));
      });
    });
  }

  void fail(const Error& error) {
    if (!is_of_http(error)) return close();  // gone, or too slow
    respond(answer_to_error(error));
  }

  void respond(HttpResponse answer) {
    ++hub_.answers[answer.status];
    if (std::exchange(large_, false)) --hub_.large_bodies;
    const bool read = parser_->is_done();
    response_ = {};
    // the older stream gets the stored event
    response_.version(parser_->get().version() == 10 ? 10 : 11);
    response_.result(answer.status);
    set_common_fields(&response_, is_tls);
    response_.set(http::field::content_type, answer.type);
    for (const auto& [name, value] : answer.fields) response_.set(name, value);
    response_.body() = std::move(answer.body);
    response_.keep_alive(read && parser_->get().keep_alive() && !is_reserve());
    response_.prepare_payload();
    if (parser_->get().method() == http::verb::head) response_.body().clear();
    question_ = {};
    tcp().expires_after(hub_.limits.write);
    http::async_write(stream_, response_, [self = self(), read](Error error, std::size_t) {
      if (error) return self->close();
      if (self->response_.keep_alive()) return self->read_header();
      read ? self->finish() : self->drain(0);
    });
  }

  // A client that is still sending would not see the answer if the connection closed immediately.
  void drain(std::size_t so_far) {
    if (so_far == 0) tcp().expires_after(std::chrono::seconds(2));
    if (so_far > hub_.limits.body_bytes) return close();
    tcp().async_read_some(net::buffer(scrap_),
                          [self = self(), so_far](Error error, std::size_t count) {
                            if (error) return self->close();
                            self->drain(so_far + count);
                          });
  }

  void finish() {
    if constexpr (is_tls) {
      tcp().expires_after(std::chrono::seconds(2));
      stream_.async_shutdown([self = self()](Error) { self->close(); });
    } else {
      Error ignored;
      tcp().socket().shutdown(net::ip::tcp::socket::shutdown_both, ignored);
      close();
    }
  }

  void leave_streams() {
    if (hub_.streams.erase(this) == 0) return;
    const auto own = hub_.streams_of_client.find(client_);
    if (--own->second == 0) hub_.streams_of_client.erase(own);
  }

  void listen() {
    if (hub_.streams.size() >= hub_.limits.streams) {
      HttpResponse answer = refusal(503, "too many clients listen to events already");
      answer.fields.emplace_back("Retry-After", "10");
      return respond(std::move(answer));
    }
    const auto own = hub_.streams_of_client.find(client_);
    if (own != hub_.streams_of_client.end() && own->second >= hub_.limits.streams_of_client) {
      HttpResponse answer = refusal(503, "this client listens to events too often already");
      answer.fields.emplace_back("Retry-After", "10");
      return respond(std::move(answer));
    }
    ++hub_.answers[200];
    hub_.streams.insert(this);
    ++hub_.streams_of_client[client_];
    version_ = hub_.handler.version_of(question_.last_event_id);
    http::response<http::empty_body> head(http::status::ok, 11);
    set_common_fields(&head, is_tls);
    head.set(http::field::content_type, "text/event-stream; charset=utf-8");
    head.keep_alive(false);
    // A client that does not read may hold only little memory, including the kernel's.
    Error ignored;
    tcp().socket().set_option(net::socket_base::send_buffer_size(64 * 1024), ignored);
    // No data is expected; the read only detects that the client has gone.
    tcp().expires_never();
    stream_.async_read_some(net::buffer(scrap_), [self = self()](Error, std::size_t) {
      self->leave_streams();
      self->close();
    });
    std::ostringstream text;
    text << head.base() << "retry: 2000\n\n";
    send(std::make_shared<std::string>(text.str()), version_);
  }

  HttpHub& hub_;
  const std::string client_;
  Stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  HttpRequest question_;
  http::response<http::string_body> response_;
  std::array<char, 4096> scrap_;
  std::shared_ptr<const std::string> event_;
  std::optional<std::uint64_t> version_;
  bool writing_ = false;
  bool idle_ = true;
  bool large_ = false;  ///< whether it counts among `large_bodies`
};

}  // namespace

std::shared_ptr<HttpConnection> make_connection(net::ip::tcp::socket socket,
                                                const std::string& client, HttpHub* hub) {
  if (!hub->tls) return std::make_shared<Connection<Plain>>(hub, client, std::move(socket));
  return std::make_shared<Connection<TlsStream>>(hub, client, std::move(socket), *hub->tls);
}

}  // namespace wearwell
