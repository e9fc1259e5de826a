#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/monitor/http_message.h"
#include "wearwell/monitor/http_settings.h"

namespace wearwell::monitor {

/// Whom the server answers.
///
/// A page from elsewhere that runs in the browser of somebody who may ask is held off threefold: its name is
/// not one of ours, also where its owner lets it point to our address (DNS rebinding: `Host`); what it sends
/// says where it comes from (`Origin`, `Sec-Fetch-Site`); and it gets no leave to read answers (no CORS).
class HttpAccess {
 public:
  /// `covered`: whether a name is one of the certificate's; empty without TLS.
  HttpAccess(const HttpSettings& settings, std::function<bool(const std::string&)> covered);

  /// Why a request is refused, whoever sends it: 400, 403 or 421.
  std::optional<HttpResponse> refuse(const HttpRequest& question) const;

  /// Whether it bears the token, or the cookie that `cookie` gave within its time. `now`: Unix time in s.
  bool authorized(const HttpRequest& question, std::int64_t now) const;
  bool needs_token() const { return !token_.empty(); }
  bool is_token(std::string_view text) const;

  /// `Set-Cookie` for who has shown the token: it holds the time when it ends and a keyed hash (HMAC-SHA-256)
  /// of that, not the token, and another token makes it worthless.
  std::string cookie(std::int64_t now) const;
  std::string no_cookie() const;  ///< takes it away

 private:
  bool is_ours(const std::string& name) const;
  std::string seal(std::int64_t until) const;

  std::string token_;
  std::vector<std::string> names_;
  std::function<bool(const std::string&)> covered_;
  bool secure_;
};

/// Equal texts, in a time that does not depend on where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// Throws InputError for a token that could be guessed or sent in no header: fewer than 16 characters, or
/// others than visible ASCII.
void check_token(const std::string& token);

}  // namespace wearwell::monitor
