#pragma once

#include <openssl/ssl.h>

#include <memory>
#include <optional>
#include <string>

#include "wearwell/http/settings.h"

namespace wearwell {

/// TLS 1.2 and 1.3 with the certificate and key of the settings.
class HttpTls {
 public:
  /// Throws InputError, naming the file, if either cannot be read, is not PEM, or they do not
  /// match.
  HttpTls(const std::filesystem::path& certificate, const std::filesystem::path& key);

  SSL_CTX* context() const { return context_.get(); }
  /// Whether a name is in the certificate, including names like "*.example.org".
  bool covers(const std::string& name) const;

 private:
  std::shared_ptr<SSL_CTX> context_;
};

/// With the certificate and key of the settings; empty without. Throws InputError if one of the two
/// is missing, and like HttpTls.
std::optional<HttpTls> tls_of(const HttpSettings& settings);

}  // namespace wearwell
