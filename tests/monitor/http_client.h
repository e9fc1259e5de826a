#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <utility>

#include "support/free_port.h"

namespace wearwell::monitor {

/// What came back, taken apart.
struct HttpReply {
  int status = 0;  ///< 0: nothing that is an answer
  std::string head, body;

  /// The value of a field, "" where there is none.
  std::string field(const std::string& name) const {
    const std::size_t at = head.find("\r\n" + name + ": ");
    if (at == std::string::npos) return {};
    const std::size_t from = at + name.size() + 4;
    return head.substr(from, head.find("\r\n", from) - from);
  }
};

/// A socket that says what it is told to say, HTTP or not. Never waits longer than 20 s.
class HttpClient {
 public:
  /// `from`: an address of this machine; null: any.
  explicit HttpClient(unsigned short port, int receive_buffer = 0, const char* from = nullptr)
      : descriptor_(socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) {
      setsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    if (from) {
      sockaddr_in own = loopback(0);
      inet_pton(AF_INET, from, &own.sin_addr);
      if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
        throw std::runtime_error("cannot bind");
    }
    const sockaddr_in address = loopback(port);
    if (connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("cannot connect");
    }
  }
  ~HttpClient() { close(descriptor_); }
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  /// False once the server has closed.
  bool send(const std::string& text) {
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t count =
          ::send(descriptor_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return false;
      sent += static_cast<std::size_t>(count);
    }
    return true;
  }

  /// Says nothing more, but listens.
  void finish() { shutdown(descriptor_, SHUT_WR); }

  /// More of what comes, false at its end.
  bool receive(std::string* text) {
    pollfd ready{descriptor_, POLLIN, 0};
    if (poll(&ready, 1, 20000) <= 0) throw std::runtime_error("nothing came for 20 s");
    char buffer[65536];
    const ssize_t count = recv(descriptor_, buffer, sizeof buffer, 0);
    if (count <= 0) return false;
    text->append(buffer, static_cast<std::size_t>(count));
    return true;
  }

  /// All until the server closes.
  std::string rest() {
    std::string text = std::exchange(held_, {});
    while (receive(&text)) {
    }
    return text;
  }

  /// Up to and with `end`; "" where the server closed before.
  std::string until(const std::string& end) {
    std::size_t at = std::string::npos;
    while ((at = held_.find(end)) == std::string::npos) {
      if (!receive(&held_)) return {};
    }
    std::string text = held_.substr(0, at + end.size());
    held_.erase(0, at + end.size());
    return text;
  }

  /// One answer, by its Content-Length.
  HttpReply reply(bool body = true) {
    HttpReply reply;
    reply.head = until("\r\n\r\n");
    if (reply.head.size() < 12) return reply;
    reply.status = std::atoi(reply.head.c_str() + 9);
    const auto length = static_cast<std::size_t>(std::atoll(reply.field("Content-Length").c_str()));
    if (!body) return reply;
    while (held_.size() < length && receive(&held_)) {
    }
    reply.body = held_.substr(0, length);
    held_.erase(0, length);
    return reply;
  }

 private:
  int descriptor_;
  std::string held_;
};

/// One request on a connection of its own.
inline HttpReply ask(unsigned short port, const std::string& request) {
  HttpClient client(port);
  client.send(request);
  return client.reply();
}

inline std::string request_of(const std::string& line, const std::string& fields = {},
                              const std::string& body = {}) {
  return line + " HTTP/1.1\r\nHost: localhost\r\n" + fields +
         (body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n") + "\r\n" +
         body;
}

inline HttpReply get(unsigned short port, const std::string& target,
                     const std::string& fields = {}) {
  return ask(port, request_of("GET " + target, fields));
}

inline HttpReply post(unsigned short port, const std::string& target, const std::string& body,
                      const std::string& fields = {}) {
  return ask(port, request_of("POST " + target, fields, body));
}

}  // namespace wearwell::monitor
