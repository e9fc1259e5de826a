#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wearwell {

/// A self-contained page; it requests nothing except from its own server.
struct ServedPage {
  std::string html;
  std::string policy;  ///< its Content-Security-Policy
  std::string tag;     ///< its ETag
};

/// A style or a script, and its SHA-256 in hexadecimal digits (cmake/resources.cmake).
struct PagePart {
  std::string_view text, sha256;
};

/// What every page begins with (page.css, page_words.js).
PagePart page_style();
PagePart page_words();

/// The page with this body (markup), styles and scripts, which alone may run. `frames`: whether it
/// may show other pages of its server in frames.
ServedPage served_page(const std::string& title, std::string_view body,
                       const std::vector<PagePart>& styles, const std::vector<PagePart>& scripts,
                       bool frames = false);

}  // namespace wearwell
