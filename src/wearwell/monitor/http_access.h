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

  /// What the sender may do, of HttpRole: by its token, or by a valid cookie from `cookie`; all
  /// without tokens, 0 for a wrong one. `now`: Unix time in s.
  unsigned roles(const HttpRequest& question, std::int64_t now) const;
  bool needs_token() const { return !tokens_.empty(); }
  /// The roles of a token; 0 if it is none.
  unsigned roles_of_token(std::string_view text) const;

  /// `Set-Cookie` for a client that has shown this token: it contains its expiry time and a keyed
  /// hash (HMAC-SHA-256) of it, not the token; a new token invalidates it.
  std::string cookie(std::string_view token, std::int64_t now) const;
  std::string no_cookie() const;  ///< removes it

 private:
  bool is_ours(const std::string& name) const;
  static std::string seal(std::string_view token, std::int64_t until);

  std::vector<HttpToken> tokens_;
  std::vector<std::string> names_;
  std::function<bool(const std::string&)> covered_;
  bool secure_;
};

/// Throws InputError for a token that could be guessed or that no header can carry: fewer than 16
/// characters, or characters other than visible ASCII.
void check_token(const std::string& token);

/// "read", "write" or "operate".
std::optional<unsigned> role_named(std::string_view name);
/// "read and operate", for messages.
std::string role_names(unsigned roles);

}  // namespace wearwell::monitor
