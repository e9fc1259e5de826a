#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wearwell/input/toml_reader.h"

/// Values that several tables of a monitor's configuration have. All throw InputError that names the key.
namespace wearwell::monitor {

/// The folder of the file, to which its paths are relative.
std::filesystem::path folder_of(const TomlReader& reader);

/// A file or folder that exists.
std::filesystem::path existing(const TomlReader& table, const char* key);

struct HostAndPort {
  std::string host;
  int port = 0;
};

/// "host:port", "[::1]:port"; the port may be omitted if there is a default.
HostAndPort read_address(const TomlReader& table, const char* key, std::string_view text,
                         int usual_port);

/// The first line of a file with a secret.
std::string read_secret(const TomlReader& table, const char* key);

/// Whether this machine alone can reach an address.
bool is_loopback(const std::string& host);

}  // namespace wearwell::monitor
