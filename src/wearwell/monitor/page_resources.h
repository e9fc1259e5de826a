#pragma once

#include <string_view>

/// Files of the page that are embedded in the program (cmake/resources.cmake). `_sha256` is in
/// hexadecimal digits.
namespace wearwell::resource {

std::string_view monitor_openapi();
std::string_view monitor_html();
std::string_view monitor_css();
std::string_view monitor_css_sha256();
std::string_view monitor_words_js();
std::string_view monitor_words_js_sha256();
std::string_view monitor_plot_js();
std::string_view monitor_plot_js_sha256();
std::string_view monitor_list_js();
std::string_view monitor_list_js_sha256();
std::string_view monitor_events_js();
std::string_view monitor_events_js_sha256();
std::string_view monitor_fits_js();
std::string_view monitor_fits_js_sha256();
std::string_view monitor_detail_js();
std::string_view monitor_detail_js_sha256();
std::string_view monitor_live_js();
std::string_view monitor_live_js_sha256();

}  // namespace wearwell::resource
