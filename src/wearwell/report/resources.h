#pragma once

#include <string_view>

/// Files that the program carries with it (cmake/resources.cmake).
namespace wearwell::resource {

std::string_view vega();  ///< JavaScript
std::string_view vega_license();
std::string_view vega_lite();
std::string_view vega_lite_license();
std::string_view vega_embed();
std::string_view vega_embed_license();
std::string_view page_css();
std::string_view page_js();

}  // namespace wearwell::resource
