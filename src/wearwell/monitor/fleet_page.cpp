#include "wearwell/monitor/fleet_page.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <string_view>
#include <vector>

#include "wearwell/monitor/page_resources.h"

namespace wearwell::monitor {
namespace {

struct Part {
  std::string_view text, sha256;
};

int digit(char hexadecimal) {
  return hexadecimal <= '9' ? hexadecimal - '0' : hexadecimal - 'a' + 10;
}

// In base 64, as browsers need hashes.
std::string source_of(const Part& part) {
  std::array<unsigned char, 32> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] =
        static_cast<unsigned char>(digit(part.sha256[2 * i]) * 16 + digit(part.sha256[2 * i + 1]));
  }
  std::array<unsigned char, 45> text;
  const int length = EVP_EncodeBlock(text.data(), bytes.data(), bytes.size());
  return fmt::format(" 'sha256-{}'", std::string_view(reinterpret_cast<const char*>(text.data()),
                                                      static_cast<std::size_t>(length)));
}

ServedPage page_of(const std::string& title, std::string_view body, const Part& style,
                   const std::vector<Part>& scripts) {
  std::string code, sources;
  for (const Part& each : scripts) {
    code += fmt::format("<script>{}</script>\n", each.text);
    sources += source_of(each);
  }
  ServedPage page;
  page.policy = fmt::format(
      "default-src 'none'; base-uri 'none'; frame-ancestors 'none'; form-action 'self'; "
      "connect-src 'self'; img-src data:; style-src{}; script-src{}",
      source_of(style), sources.empty() ? " 'none'" : sources);
  page.html = fmt::format(R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{}</title>
<style>{}</style>
</head>
<body>
{}{}</body>
</html>
)",
                          title, style.text, body, code);
  // Part of the hash, enough to distinguish versions of the page.
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned length = 0;
  EVP_Digest(page.html.data(), page.html.size(), digest.data(), &length, EVP_sha256(), nullptr);
  page.tag = "\"";
  for (int i = 0; i < 12; ++i) page.tag += fmt::format("{:02x}", digest[i]);
  page.tag += '"';
  return page;
}

constexpr std::string_view sign_out =
    R"(<footer><form method="post" action="/logout"><button>Sign out</button></form></footer>
)";

constexpr std::string_view login_body = R"(<main class="login">
<h1>wearwell monitor</h1>
<form method="post" action="/login">
<label for="token">Token</label>
<input id="token" name="token" type="password" required autocomplete="current-password">
{}<button>Sign in</button>
</form>
</main>
)";

}  // namespace

ServedPage fleet_page(bool token) {
  namespace of = resource;
  std::string body(of::monitor_html());
  if (token) body += sign_out;
  return page_of("wearwell monitor", body, {of::monitor_css(), of::monitor_css_sha256()},
                 {{of::monitor_words_js(), of::monitor_words_js_sha256()},
                  {of::monitor_plot_js(), of::monitor_plot_js_sha256()},
                  {of::monitor_list_js(), of::monitor_list_js_sha256()},
                  {of::monitor_events_js(), of::monitor_events_js_sha256()},
                  {of::monitor_fits_js(), of::monitor_fits_js_sha256()},
                  {of::monitor_detail_js(), of::monitor_detail_js_sha256()},
                  {of::monitor_live_js(), of::monitor_live_js_sha256()}});
}

ServedPage login_page(bool wrong) {
  const char* note = wrong ? "<p class=\"wrong\" role=\"alert\">This is not the token.</p>\n" : "";
  return page_of("wearwell monitor: sign in", fmt::format(login_body, note),
                 {resource::monitor_css(), resource::monitor_css_sha256()}, {});
}

}  // namespace wearwell::monitor
