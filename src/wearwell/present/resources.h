#pragma once

#include <string_view>

/// Files embedded in the program (cmake/resources.cmake).
namespace wearwell::resource {

std::string_view vega();         ///< JavaScript
std::string_view vega_sha256();  ///< of it, in hexadecimal digits
std::string_view vega_license();
std::string_view vega_lite();
std::string_view vega_lite_sha256();
std::string_view vega_lite_license();
std::string_view vega_embed();
std::string_view vega_embed_sha256();
std::string_view vega_embed_license();
std::string_view page_css();
std::string_view page_js();
std::string_view page_js_sha256();

}  // namespace wearwell::resource
