#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "wearwell/http/handler.h"
#include "wearwell/http/settings.h"

namespace wearwell {

/// One client. All of it runs on the thread of the server's `io`.
class HttpConnection {
 public:
  virtual ~HttpConnection() = default;
  virtual void start() = 0;
  virtual void close() = 0;
  /// Whether no whole request has arrived since the last answer.
  virtual bool idle() const = 0;
  /// Of a stream of events: whether it has received the last event, its version, and the next
  /// event.
  virtual bool waits() const = 0;
  virtual std::optional<std::uint64_t> version() const = 0;
  virtual void send(std::shared_ptr<const std::string> event,
                    std::optional<std::uint64_t> reached) = 0;
};

/// The parts that connections share.
struct HttpHub {
  HttpHub(const HttpHandler& of, const HttpLimits& all_limits) : handler(of), limits(all_limits) {}

  const HttpHandler& handler;
  const HttpLimits limits;
  std::unique_ptr<boost::asio::ssl::context> tls;  ///< null: plain HTTP
  // Only for the thread of `io`; connections remove themselves when they end.
  std::set<HttpConnection*> connections, streams;
  std::map<std::string, std::size_t> of_client;  ///< connections, but for those of the reserve
  std::map<std::string, std::size_t> streams_of_client;
  std::list<HttpConnection*> reserve;  ///< the oldest first; not among `connections`
  std::map<unsigned, std::uint64_t> answers;
  std::size_t large_bodies = 0;  ///< being sent or processed
  boost::asio::io_context io{1};
  boost::asio::thread_pool readers{2}, deliveries{2};
};

/// `client`: of `of_client`; empty: a connection of the reserve.
std::shared_ptr<HttpConnection> make_connection(boost::asio::ip::tcp::socket socket,
                                                const std::string& client, HttpHub* hub);

}  // namespace wearwell
