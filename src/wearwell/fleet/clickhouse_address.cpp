#include "wearwell/fleet/clickhouse_address.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/split.hpp>
#include <cctype>
#include <charconv>
#include <cstdlib>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::fleet {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw InputError("--engine: " + why +
                   "; an address is clickhouse://USER:PASSWORD@HOST:PORT/DATABASE, or "
                   "clickhouses://... with TLS");
}

std::string plain(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    unsigned byte = 0;
    const char* const from = text.data() + i + 1;
    const char* const to = text.data() + std::min(text.size(), i + 3);
    const auto read = std::from_chars(from, to, byte, 16);
    if (to - from != 2 || read.ptr != to || byte == 0)
      refuse("a % must start an encoded byte ('%25' is %)");
    out += static_cast<char>(byte);
    i += 2;
  }
  return out;
}

HttpPlace place_of(const std::string& text, bool tls) {
  std::string host = text, port = tls ? "8443" : "8123";
  const std::size_t bracket = text.rfind(']'), colon = text.rfind(':');
  if (colon != text.npos && (bracket == text.npos || colon > bracket)) {
    host = text.substr(0, colon);
    port = text.substr(colon + 1);
  }
  if (host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  unsigned number = 0;
  const auto read = std::from_chars(port.data(), port.data() + port.size(), number);
  if (read.ptr != port.data() + port.size() || number < 1 || number > 65535)
    refuse(fmt::format("'{}' is not a port", printable(shortened(port))));
  const bool good = !host.empty() && std::all_of(host.begin(), host.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '.' || c == '-' || c == '_' || c == ':' || c == '%';
  });
  if (!good) refuse(fmt::format("'{}' is not a host name", printable(shortened(host))));
  return {host, port, tls};
}

}  // namespace

ClickhouseAddress read_clickhouse_address(const std::string& text) {
  const std::size_t begin = text.find("://");
  if (begin == text.npos) refuse("'://' is missing");
  const std::string scheme = text.substr(0, begin);
  const bool tls = scheme == "clickhouses" || scheme == "https";
  std::string hosts = text.substr(begin + 3);
  ClickhouseAddress address;
  if (const std::size_t at = hosts.rfind('@'); at != hosts.npos) {
    const std::string login = hosts.substr(0, at);
    hosts.erase(0, at + 1);
    const std::size_t colon = login.find(':');
    address.user = plain(login.substr(0, colon));
    if (colon != login.npos) address.password = plain(login.substr(colon + 1));
  }
  if (address.password.empty()) {
    if (const char* known = std::getenv("CLICKHOUSE_PASSWORD")) address.password = known;
  }
  for (const std::string* each : {&address.user, &address.password})
    if (std::any_of(each->begin(), each->end(), [](unsigned char c) { return std::iscntrl(c); }))
      refuse("user and password must not contain control characters");
  if (const std::size_t slash = hosts.find('/'); slash != hosts.npos) {
    if (slash + 1 < hosts.size()) address.database = plain(hosts.substr(slash + 1));
    hosts.erase(slash);
  }
  if (address.database.find_first_of("/?#") != std::string::npos)
    refuse(fmt::format("'{}' is not a database name", printable(shortened(address.database))));
  std::vector<std::string> all;
  boost::algorithm::split(all, hosts, boost::algorithm::is_any_of(","));
  for (const std::string& each : all) address.hosts.push_back(place_of(each, tls));
  return address;
}

std::string url_part(const std::string& text) {
  std::string out;
  for (const char each : text) {
    const auto c = static_cast<unsigned char>(each);
    if (std::isalnum(c) || c == '-' || c == '_' || c == '.') {
      out += each;
    } else {
      out += fmt::format("%{:02X}", c);
    }
  }
  return out;
}

}  // namespace wearwell::fleet
