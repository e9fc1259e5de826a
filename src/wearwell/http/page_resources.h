#pragma once

#include <string_view>

/// Files that pages share, embedded in the program (cmake/resources.cmake). `_sha256` is in
/// hexadecimal digits.
namespace wearwell::resource {

std::string_view http_page_css();
std::string_view http_page_css_sha256();
std::string_view http_words_js();
std::string_view http_words_js_sha256();

}  // namespace wearwell::resource
