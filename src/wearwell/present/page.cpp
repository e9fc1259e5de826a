#include "wearwell/present/page.h"

#include <fmt/format.h>

#include <string_view>

#include "wearwell/present/html.h"
#include "wearwell/present/resources.h"

namespace wearwell {
namespace {

using html::escape;

// Appended: the scripts are nearly all of a page.
void add_script(std::string& out, std::string_view code) {
  out.append("<script>").append(code).append("</script>\n");
}

// The licenses require that their text accompanies the code.
void add_licence(std::string& out, std::string_view name, std::string_view text) {
  out.append("<!-- ").append(name).append(" in this page:\n").append(text).append("\n-->\n");
}

int digit(char hexadecimal) {
  return hexadecimal <= '9' ? hexadecimal - '0' : hexadecimal - 'a' + 10;
}

// 32 bytes in hexadecimal digits -> in base 64, as browsers want them.
std::string base64(std::string_view digits) {
  static constexpr char letters[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0;
  int held = 0;
  for (const char each : digits) {
    bits = bits << 4 | static_cast<unsigned>(digit(each));
    held += 4;
    if (held < 6) continue;
    held -= 6;
    out += letters[bits >> held & 63];
  }
  if (held > 0) out += letters[bits << (6 - held) & 63];
  while (out.size() % 4 != 0) out += '=';
  return out;
}

// Only scripts of this program run, even for a result from elsewhere; no eval, and nothing is
// fetched, sent or framed.
std::string content_security_policy() {
  std::string scripts;
  for (const std::string_view each : {resource::vega_sha256(), resource::vega_lite_sha256(),
                                      resource::vega_embed_sha256(), resource::page_js_sha256()}) {
    scripts += fmt::format(" 'sha256-{}'", base64(each));
  }
  return fmt::format(
      "default-src 'none'; base-uri 'none'; form-action 'none'; style-src 'unsafe-inline'; "
      "img-src data: blob:; script-src{}",
      scripts);
}

}  // namespace

std::string html_page(const Page& page) {
  std::string navigation;
  for (const present::Section& section : page.sections) {
    navigation +=
        fmt::format("<li><a href=\"#{}\">{}</a></li>", escape(section.id), escape(section.name));
  }
  std::string out = fmt::format(
      R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="wearwell {}">
<title>{}</title>
<style>{}</style>
</head>
<body>
<header><h1>{}</h1><p>{}</p>
<nav aria-label="Contents"><ul>{}</ul></nav></header>
<main>
)",
      content_security_policy(), escape(page.version), escape(page.title), resource::page_css(),
      escape(page.title), escape(page.subtitle), navigation);
  for (const present::Section& section : page.sections) {
    out += html::section(section.id, section.title.empty() ? section.name : section.title,
                         present::html_of(section));
  }
  out += fmt::format("</main>\n<footer><p>Written by wearwell {}.</p></footer>\n",
                     escape(page.version));
  constexpr std::size_t rest = 20'000;  // licenses and page.js
  out.reserve(out.size() + resource::vega().size() + resource::vega_lite().size() +
              resource::vega_embed().size() + rest);
  add_licence(out, "vega", resource::vega_license());
  add_script(out, resource::vega());
  add_licence(out, "vega-lite", resource::vega_lite_license());
  add_script(out, resource::vega_lite());
  add_licence(out, "vega-embed", resource::vega_embed_license());
  add_script(out, resource::vega_embed());
  add_script(out, resource::page_js());
  out += "</body>\n</html>\n";
  return out;
}

}  // namespace wearwell
