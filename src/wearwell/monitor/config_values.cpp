#include "wearwell/monitor/config_values.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <charconv>
#include <fstream>

#include "wearwell/base/error.h"

namespace wearwell::monitor {

std::filesystem::path folder_of(const TomlReader& reader) {
  return std::filesystem::path(reader.file()).parent_path();
}

std::filesystem::path existing(const TomlReader& table, const char* key) {
  const std::filesystem::path path = folder_of(table) / table.required_text(key);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    table.fail(key, fmt::format("no such file or folder: {}", path.string()));
  return path;
}

HostAndPort read_address(const TomlReader& table, const char* key, std::string_view text,
                         int usual_port) {
  HostAndPort address{"", usual_port};
  std::string_view port;
  bool has_port = false;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == text.npos) table.fail(key, "has an unclosed bracket");
    address.host = text.substr(1, end - 1);
    has_port = text.substr(end + 1).starts_with(':');
    if (has_port) port = text.substr(end + 2);
  } else {
    const std::size_t colon = text.find(':');
    address.host = text.substr(0, colon);
    has_port = colon != text.npos;
    if (has_port) port = text.substr(colon + 1);
  }
  if (has_port) {
    const auto [rest, error] =
        std::from_chars(port.data(), port.data() + port.size(), address.port);
    if (error != std::errc() || rest != port.data() + port.size()) address.port = -1;
  }
  if (address.host.empty() || address.host.find_first_of("/@ ") != std::string::npos ||
      address.port < 1 || address.port > 65535)
    table.fail(key, fmt::format("'{}' is not HOST:PORT", text));
  return address;
}

std::string read_secret(const TomlReader& table, const char* key) {
  const std::filesystem::path file = existing(table, key);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    table.fail(key, fmt::format("{} must be a file with one line", file.string()));
  std::ifstream stream(file, std::ios::binary);
  if (!stream) table.fail(key, fmt::format("{} cannot be read (permissions?)", file.string()));
  constexpr std::size_t longest = 1 << 16;  // bytes
  std::string text(longest, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(longest));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() == longest) table.fail(key, "must be a file with one line");
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  if (text.empty() || text.find_first_of("\r\n") != text.npos)
    table.fail(key, "must be a file with one line");
  return text;
}

bool is_loopback(const std::string& host) {
  in_addr four{};
  in6_addr six{};
  if (inet_pton(AF_INET, host.c_str(), &four) == 1) return ntohl(four.s_addr) >> 24 == 127;
  if (inet_pton(AF_INET6, host.c_str(), &six) == 1) return IN6_IS_ADDR_LOOPBACK(&six) != 0;
  return host == "localhost";
}

}  // namespace wearwell::monitor
