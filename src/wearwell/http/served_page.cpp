#include "wearwell/http/served_page.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>

#include "wearwell/http/page_resources.h"

namespace wearwell {
namespace {

int nibble(char hexadecimal) {
  return hexadecimal <= '9' ? hexadecimal - '0' : hexadecimal - 'a' + 10;
}

// In base 64, as browsers need hashes.
std::string hash_source(const PagePart& part) {
  std::array<unsigned char, 32> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<unsigned char>(nibble(part.sha256[2 * i]) * 16 +
                                          nibble(part.sha256[2 * i + 1]));
  }
  std::array<unsigned char, 45> text;
  const int length = EVP_EncodeBlock(text.data(), bytes.data(), bytes.size());
  return fmt::format(" 'sha256-{}'", std::string_view(reinterpret_cast<const char*>(text.data()),
                                                      static_cast<std::size_t>(length)));
}

}  // namespace

PagePart page_style() {
  return {resource::http_page_css(), resource::http_page_css_sha256()};
}

PagePart page_words() {
  return {resource::http_words_js(), resource::http_words_js_sha256()};
}

ServedPage served_page(const std::string& title, std::string_view body,
                       const std::vector<PagePart>& styles, const std::vector<PagePart>& scripts,
                       bool frames) {
  std::string style, style_sources, code, sources;
  for (const PagePart& each : styles) {
    style += fmt::format("<style>{}</style>\n", each.text);
    style_sources += hash_source(each);
  }
  for (const PagePart& each : scripts) {
    code += fmt::format("<script>{}</script>\n", each.text);
    sources += hash_source(each);
  }
  ServedPage page;
  page.policy = fmt::format(
      "default-src 'none'; base-uri 'none'; frame-ancestors 'none'; form-action 'self'; "
      "connect-src 'self'; img-src data:; frame-src {}; style-src{}; script-src{}",
      frames ? "'self'" : "'none'", style_sources, sources.empty() ? " 'none'" : sources);
  page.html = fmt::format(R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{}</title>
{}</head>
<body>
{}{}</body>
</html>
)",
                          title, style, body, code);
  // Part of the hash, enough to distinguish versions of the page.
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned length = 0;
  EVP_Digest(page.html.data(), page.html.size(), digest.data(), &length, EVP_sha256(), nullptr);
  page.tag = "\"";
  for (int i = 0; i < 12; ++i) page.tag += fmt::format("{:02x}", digest[i]);
  page.tag += '"';
  return page;
}

}  // namespace wearwell
