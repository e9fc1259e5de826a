#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/http/message.h"
#include "wearwell/http/settings.h"

namespace wearwell::monitor {

/// The access rules of the server.
///
/// Three measures protect against pages of other sites in the browser of an authorized user: their
/// name is not one of ours, even if their owner points it to our address (DNS rebinding: `Host`);
/// their requests carry their origin (`Origin`, `Sec-Fetch-Site`); and they may not read answers
/// (no CORS).
class HttpAccess {
 public:
  /// `covered`: whether a name is in the certificate; empty without TLS.
  HttpAccess(const HttpSettings& settings, std::function<bool(const std::string&)> covered);

  /// Why a request is refused, for any sender: 400, 403 or 421.
  std::optional<HttpResponse> refuse(const HttpRequest& question) const;

  /// Whether it has the token, or a valid cookie from `cookie`. `now`: Unix time in s.
  bool authorized(const HttpRequest& question, std::int64_t now) const;
  bool needs_token() const { return !token_.empty(); }
  bool is_token(std::string_view text) const;

  /// `Set-Cookie` for a client that has shown the token: it contains its expiry time and a keyed
  /// hash (HMAC-SHA-256) of it, not the token; a new token invalidates it.
  std::string cookie(std::int64_t now) const;
  std::string no_cookie() const;  ///< removes it

 private:
  bool is_ours(const std::string& name) const;
  std::string seal(std::int64_t until) const;

  std::string token_;
  std::vector<std::string> names_;
  std::function<bool(const std::string&)> covered_;
  bool secure_;
};

/// Throws InputError for a token that could be guessed or that no header can carry: fewer than 16
/// characters, or characters other than visible ASCII.
void check_token(const std::string& token);

}  // namespace wearwell::monitor
