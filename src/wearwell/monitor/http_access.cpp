#include "wearwell/monitor/http_access.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/http/secret.h"

namespace wearwell::monitor {
namespace {

constexpr std::int64_t cookie_seconds = 30 * 24 * 3600;
constexpr std::string_view cookie_name = "wearwell";

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return c < 128 ? std::tolower(c) : c; });
  return text;
}

/// "machine:8080" -> "machine", "[::1]:8080" -> "::1".
std::string name_of(const std::string& host) {
  if (host.starts_with('[')) return host.substr(1, host.find(']') - 1);
  return lower(host.substr(0, host.find(':')));
}

bool is_address(const std::string& name) {
  std::array<unsigned char, sizeof(in6_addr)> bytes;
  return inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

}  // namespace

void check_token(const std::string& token) {
  constexpr std::size_t least = 16;
  const bool visible =
      std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  if (!visible) {
    throw InputError("the token has characters other than visible ASCII: no header can carry it");
  }
  if (token.size() < least) {
    throw InputError(
        fmt::format("the token has {} characters: use at least {} random ones, for example from "
                    "\"openssl rand -hex 16\"",
                    token.size(), least));
  }
}

namespace {

constexpr std::pair<HttpRole, std::string_view> named_roles[] = {
    {role_read, "read"}, {role_write, "write"}, {role_operate, "operate"}};

}  // namespace

std::optional<unsigned> role_named(std::string_view name) {
  for (const auto& [role, text] : named_roles) {
    if (text == name) return role;
  }
  return {};
}

std::string role_names(unsigned roles) {
  std::string text;
  for (const auto& [role, name] : named_roles) {
    if (roles & role) text += fmt::format("{}{}", text.empty() ? "" : " and ", name);
  }
  return text;
}

HttpAccess::HttpAccess(const HttpSettings& settings,
                       std::function<bool(const std::string&)> covered)
    : tokens_(settings.tokens),
      covered_(std::move(covered)),
      secure_(!settings.certificate.empty()) {
  if (!settings.token.empty()) tokens_.push_back({"token", settings.token, role_all});
  for (const HttpToken& each : tokens_) check_token(each.token);
  names_ = {"localhost", lower(settings.host)};
  for (const std::string& each : settings.names) names_.push_back(lower(each));
}

// An address is always ours: only a name can be pointed elsewhere.
bool HttpAccess::is_ours(const std::string& name) const {
  return is_address(name) || std::find(names_.begin(), names_.end(), name) != names_.end() ||
         (covered_ && covered_(name));
}

std::optional<HttpResponse> HttpAccess::refuse(const HttpRequest& question) const {
  if (question.host.empty()) return refusal(400, "the request has no Host, or more than one");
  const std::string name = name_of(question.host);
  if (!is_ours(name)) {
    return refusal(
        421,
        fmt::format("\"{}\" is not a name of this server; add it to names in the configuration",
                    shortened(name)));
  }
  const std::string& origin = question.origin;
  if (!origin.empty()) {
    const std::size_t at = origin.find("://");
    const std::string from = at == origin.npos ? "" : lower(origin.substr(at + 3));
    const bool listed = std::find(names_.begin() + 1, names_.end(), name_of(from)) != names_.end();
    if (from != lower(question.host) && !listed) {
      return refusal(403, "a page of another site sends this: only this server's own page may");
    }
  }
  // A link on another site may lead to the page; all else from other sites is refused.
  const bool elsewhere = question.fetch_site == "cross-site" || question.fetch_site == "same-site";
  const bool page =
      question.method == "GET" && question.target.substr(0, question.target.find('?')) == "/";
  if (elsewhere && !page) {
    return refusal(403, "a page of another site asks this: only this server's own page may");
  }
  return {};
}

// All are compared, so that the time says nothing about which one it is.
unsigned HttpAccess::roles_of_token(std::string_view text) const {
  unsigned roles = 0;
  for (const HttpToken& each : tokens_) {
    if (equal_in_constant_time(text, each.token)) roles = each.roles;
  }
  return roles;
}

unsigned HttpAccess::roles(const HttpRequest& question, std::int64_t now) const {
  if (tokens_.empty()) return role_all;
  constexpr std::string_view scheme = "bearer ";
  const std::string& field = question.authorization;
  if (lower(field.substr(0, scheme.size())) == scheme) {
    return roles_of_token(std::string_view(field).substr(scheme.size()));
  }
  const std::string_view value = cookie_value(question.cookie, cookie_name);
  std::int64_t until = 0;
  const auto [last, error] = std::from_chars(value.data(), value.data() + value.size(), until);
  if (error != std::errc{} || until < now) return 0;
  unsigned roles = 0;
  for (const HttpToken& each : tokens_) {
    if (equal_in_constant_time(value, seal(each.token, until))) roles = each.roles;
  }
  return roles;
}

std::string HttpAccess::seal(std::string_view token, std::int64_t until) {
  std::string out = fmt::format("{}.", until);
  for (const unsigned byte : hmac(token, fmt::format("wearwell session until {}", until))) {
    out += fmt::format("{:02x}", byte);
  }
  return out;
}

std::string HttpAccess::cookie(std::string_view token, std::int64_t now) const {
  return fmt::format("{}={}; Path=/; Max-Age={}; HttpOnly; SameSite=Lax{}", cookie_name,
                     seal(token, now + cookie_seconds), cookie_seconds, secure_ ? "; Secure" : "");
}

std::string HttpAccess::no_cookie() const {
  return fmt::format("{}=; Path=/; Max-Age=0; HttpOnly; SameSite=Lax{}", cookie_name,
                     secure_ ? "; Secure" : "");
}

}  // namespace wearwell::monitor
