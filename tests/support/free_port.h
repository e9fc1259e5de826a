#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>

namespace wearwell {

/// A port of the loopback, as sockets name it.
inline sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A port of loopback that nobody listens at: never the same one twice, from where processes that run side by side do not
/// meet, and below those that the system gives to clients, one of which may be taken before a server has begun.
inline int free_port() {
  constexpr int first = 10000, count = 22000;
  static int last = getpid() * 61;
  for (int tried = 0; tried < count; ++tried) {
    const int port = first + ++last % count;
    const int fd = socket(AF_INET, SOCK_STREAM, 0);
    const sockaddr_in address = loopback(port);
    const bool is_free = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(fd);
    if (is_free) return port;
  }
  throw std::runtime_error("no free port");
}

}  // namespace wearwell
