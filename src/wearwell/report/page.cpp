#include "wearwell/report/page.h"

#include <fmt/format.h>

#include "wearwell/report/html.h"
#include "wearwell/report/resources.h"

namespace wearwell {
namespace {

using html::escape;

std::string script(std::string_view code) {
  return fmt::format("<script>{}</script>\n", code);
}

// The licences ask that their text goes with the code.
std::string licence(const char* name, std::string_view text) {
  return fmt::format("<!-- {} in this page:\n{}\n-->\n", name, text);
}

}  // namespace

std::string html_page(const Page& page) {
  std::string navigation;
  for (const Page::Section& section : page.sections) {
    navigation += fmt::format("<li><a href=\"#{}\">{}</a></li>", section.id, section.name);
  }
  std::string out = fmt::format(
      R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="wearwell {}">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline' 'unsafe-eval'; img-src data: blob:">
<title>{}</title>
<style>{}</style>
</head>
<body>
<header><h1>{}</h1><p>{}</p>
<nav aria-label="Contents"><ul>{}</ul></nav></header>
<main>
)",
      escape(page.version), escape(page.title), resource::page_css(), escape(page.title),
      escape(page.subtitle), navigation);
  for (const Page::Section& section : page.sections) {
    out += html::section(section.id, section.title.empty() ? section.name : section.title,
                         section.html);
  }
  out += fmt::format("</main>\n<footer><p>Written by wearwell {}.</p></footer>\n",
                     escape(page.version));
  out += licence("vega", resource::vega_license());
  out += script(resource::vega());
  out += licence("vega-lite", resource::vega_lite_license());
  out += script(resource::vega_lite());
  out += licence("vega-embed", resource::vega_embed_license());
  out += script(resource::vega_embed());
  out += script(resource::page_js());
  return out + "</body>\n</html>\n";
}

}  // namespace wearwell
