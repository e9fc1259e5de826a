#include "wearwell/monitor/http_config.h"

#include <fmt/format.h>
#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/config_values.h"
#include "wearwell/monitor/http_access.h"

namespace wearwell::monitor {
namespace {

std::string read_token(const TomlReader& table, const char* key, const std::string& token) {
  try {
    check_token(token);
  } catch (const InputError& error) {
    table.fail(key, error.what());
  }
  return token;
}

constexpr const char* token_example =
    "token_file = \"fleet.token\", after openssl rand -hex 16 > fleet.token";

/// A token in the configuration, or in a file.
std::string read_token_or_file(const TomlReader& table) {
  const bool in_file = table.has("token_file"), here = table.has("token");
  if (in_file && here) table.fail("token_file", "is given, and token as well; use one");
  if (!in_file && !here)
    table.fail("token",
               "is missing, and so is token_file; for example: token_file = \"NAME.token\", "
               "after openssl rand -hex 16 > NAME.token");
  return in_file ? read_token(table, "token_file", read_secret(table, "token_file"))
                 : read_token(table, "token", table.required_text("token"));
}

/// [http.tokens.NAME] with a token, or a file with it, and its roles.
void read_tokens(const TomlReader& tokens, HttpSettings& http) {
  Problems problems;
  const auto read_one = [&](const std::string& name) {
    const TomlReader table = tokens.required_table(name);
    HttpToken each{name, {}, 0};
    const bool in_file = table.has("token_file");
    Problems own;
    own.in([&] { each.token = read_token_or_file(table); }, token_example);
    own.in(
        [&] {
          for (const std::string& role : table.texts("roles")) {
            const auto known = role_named(role);
            if (!known)
              table.fail("roles", fmt::format("'{}' is not a role: read, write or operate", role));
            each.roles |= *known;
          }
          if (each.roles == 0) table.fail("roles", "is missing: of read, write, operate");
        },
        "roles = [\"read\"]");
    own.finish();
    const auto same = [&](const HttpToken& other) { return other.token == each.token; };
    if (each.token == http.token || std::any_of(http.tokens.begin(), http.tokens.end(), same))
      table.fail(in_file ? "token_file" : "token",
                 "is another one's token too: who has it would not be known");
    http.tokens.push_back(std::move(each));
  };
  for (const std::string& name : tokens.keys()) problems.in([&] { read_one(name); });
  problems.finish();
}

void read_http_limits(const TomlReader& table, HttpSettings& http, Problems& problems) {
  constexpr std::int64_t most = 10'000;  // each needs a descriptor
  const auto limit = [&](const char* key, std::size_t& into) {
    problems.in(
        [&] {
          if (const auto value = table.integer(key, 1, most))
            into = static_cast<std::size_t>(*value);
        },
        fmt::format("{} = {}", key, into));
  };
  limit("connections", http.limits.connections);
  limit("connections_of_client", http.limits.of_client);
  limit("streams_of_client", http.limits.streams_of_client);
}

}  // namespace

HttpSettings read_http(const TomlReader& table) {
  HttpSettings http;
  Problems problems;
  const bool has_address = problems.in(
      [&] {
        const std::string listen = table.text("listen").value_or("127.0.0.1:8080");
        const HostAndPort address = read_address(table, "listen", listen, 8080);
        http.host = address.host;
        http.port = address.port;
      },
      "listen = \"127.0.0.1:8080\"");
  problems.in([&] { http.names = table.texts("names"); }, "names = [\"fleet.example\"]");
  problems.in([&] { http.events = table.boolean("events").value_or(true); }, "events = true");
  const std::size_t before_tokens = problems.count();
  problems.in(
      [&] {
        if (table.has("token") || table.has("token_file")) http.token = read_token_or_file(table);
      },
      token_example);
  problems.in([&] {
    if (const auto tokens = table.table("tokens")) read_tokens(*tokens, http);
  });
  read_http_limits(table, http, problems);
  const std::size_t before_files = problems.count();
  const bool tokens_are_right = before_tokens == before_files;
  for (const auto& [key, file] : {std::pair("certificate", &http.certificate), {"key", &http.key}})
    problems.in(
        [&, to = file, name = key] {
          if (table.has(name)) *to = existing(table, name);
        },
        fmt::format("{} = \"{}.pem\"", key, std::string_view(key) == "key" ? "key" : "cert"));
  if (problems.count() == before_files) {
    problems.in([&] {
      if (http.certificate.empty() != http.key.empty())
        table.fail(http.key.empty() ? "certificate" : "key",
                   "certificate and key go together; for example: certificate = \"cert.pem\" with "
                   "key = \"key.pem\"");
    });
  }
  const bool open = tokens_are_right && !http.needs_token();
  if (has_address && !is_loopback(http.host) && (open || !table.has("key"))) {
    problems.in(
        [&] {
          table.fail("listen", fmt::format("{} is reachable from other machines: set a token, a "
                                           "certificate and its key",
                                           http.host));
        },
        fmt::format("{}certificate = \"cert.pem\" and key = \"key.pem\"",
                    open ? "token_file = \"fleet.token\", " : ""));
  }
  problems.finish();
  return http;
}

}  // namespace wearwell::monitor
