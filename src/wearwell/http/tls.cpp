#include "wearwell/http/tls.h"

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/x509v3.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell {
namespace {

// The last entry of OpenSSL's queue is the most specific.
[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
  const unsigned long code = ERR_peek_last_error();
  const char* reason = ERR_reason_error_string(code);
  ERR_clear_error();
  throw InputError(fmt::format("{}: {}{}{}", printable(file.string()), what, reason ? ": " : "",
                               reason ? reason : ""));
}

}  // namespace

HttpTls::HttpTls(const std::filesystem::path& certificate, const std::filesystem::path& key)
    : context_(SSL_CTX_new(TLS_server_method()), SSL_CTX_free) {
  if (!context_) throw MachineError("TLS cannot be set up");
  SSL_CTX* const context = context_.get();
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
  SSL_CTX_set_mode(context, SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ENABLE_PARTIAL_WRITE |
                                SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  ERR_clear_error();
  if (SSL_CTX_use_certificate_chain_file(context, certificate.c_str()) != 1) {
    fail(certificate, "contains no readable certificate in PEM");
  }
  // A key with a password would prompt on the terminal.
  SSL_CTX_set_default_passwd_cb(context, [](char*, int, int, void*) { return -1; });
  if (SSL_CTX_use_PrivateKey_file(context, key.c_str(), SSL_FILETYPE_PEM) != 1) {
    fail(key, "contains no readable key in PEM, without a password, that matches the certificate");
  }
  if (SSL_CTX_check_private_key(context) != 1) fail(key, "the key does not match the certificate");
}

bool HttpTls::covers(const std::string& name) const {
  X509* const certificate = SSL_CTX_get0_certificate(context_.get());
  return X509_check_host(certificate, name.data(), name.size(), 0, nullptr) == 1;
}

std::optional<HttpTls> tls_of(const HttpSettings& settings) {
  if (settings.certificate.empty() != settings.key.empty()) {
    throw InputError("certificate and key: TLS needs both; one is missing");
  }
  if (settings.certificate.empty()) return {};
  return HttpTls(settings.certificate, settings.key);
}

}  // namespace wearwell
