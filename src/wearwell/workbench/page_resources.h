#pragma once

#include <string_view>

/// Files of the page that are embedded in the program (cmake/resources.cmake). `_sha256` is in
/// hexadecimal digits.
namespace wearwell::resource {

std::string_view workbench_html();
std::string_view workbench_css();
std::string_view workbench_css_sha256();
std::string_view workbench_strings_en_js();
std::string_view workbench_strings_en_js_sha256();
std::string_view workbench_strings_de_js();
std::string_view workbench_strings_de_js_sha256();
std::string_view workbench_language_js();
std::string_view workbench_language_js_sha256();
std::string_view workbench_focus_js();
std::string_view workbench_focus_js_sha256();
std::string_view workbench_server_js();
std::string_view workbench_server_js_sha256();
std::string_view workbench_scatter_js();
std::string_view workbench_scatter_js_sha256();
std::string_view workbench_reading_js();
std::string_view workbench_reading_js_sha256();
std::string_view workbench_headings_js();
std::string_view workbench_headings_js_sha256();
std::string_view workbench_dates_js();
std::string_view workbench_dates_js_sha256();
std::string_view workbench_data_js();
std::string_view workbench_data_js_sha256();
std::string_view workbench_priors_js();
std::string_view workbench_priors_js_sha256();
std::string_view workbench_families_js();
std::string_view workbench_families_js_sha256();
std::string_view workbench_form_js();
std::string_view workbench_form_js_sha256();
std::string_view workbench_formulas_js();
std::string_view workbench_formulas_js_sha256();
std::string_view workbench_model_js();
std::string_view workbench_model_js_sha256();
std::string_view workbench_advice_js();
std::string_view workbench_advice_js_sha256();
std::string_view workbench_fit_js();
std::string_view workbench_fit_js_sha256();
std::string_view workbench_live_js();
std::string_view workbench_live_js_sha256();
std::string_view workbench_compare_js();
std::string_view workbench_compare_js_sha256();
std::string_view workbench_ask_js();
std::string_view workbench_ask_js_sha256();
std::string_view workbench_page_js();
std::string_view workbench_page_js_sha256();

}  // namespace wearwell::resource
