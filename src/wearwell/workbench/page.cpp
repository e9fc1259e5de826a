#include "wearwell/workbench/page.h"

#include <string>

#include "wearwell/workbench/page_resources.h"

namespace wearwell::workbench {

ServedPage workbench_page() {
  namespace of = resource;
  constexpr bool frames = true;  // the report
  return served_page("wearwell", std::string(of::workbench_html()),
                     {page_style(), {of::workbench_css(), of::workbench_css_sha256()}},
                     {page_words(),
                      {of::workbench_strings_en_js(), of::workbench_strings_en_js_sha256()},
                      {of::workbench_strings_de_js(), of::workbench_strings_de_js_sha256()},
                      {of::workbench_language_js(), of::workbench_language_js_sha256()},
                      {of::workbench_focus_js(), of::workbench_focus_js_sha256()},
                      {of::workbench_server_js(), of::workbench_server_js_sha256()},
                      {of::workbench_scatter_js(), of::workbench_scatter_js_sha256()},
                      {of::workbench_reading_js(), of::workbench_reading_js_sha256()},
                      {of::workbench_headings_js(), of::workbench_headings_js_sha256()},
                      {of::workbench_dates_js(), of::workbench_dates_js_sha256()},
                      {of::workbench_data_js(), of::workbench_data_js_sha256()},
                      {of::workbench_priors_js(), of::workbench_priors_js_sha256()},
                      {of::workbench_families_js(), of::workbench_families_js_sha256()},
                      {of::workbench_form_js(), of::workbench_form_js_sha256()},
                      {of::workbench_formulas_js(), of::workbench_formulas_js_sha256()},
                      {of::workbench_model_js(), of::workbench_model_js_sha256()},
                      {of::workbench_advice_js(), of::workbench_advice_js_sha256()},
                      {of::workbench_live_js(), of::workbench_live_js_sha256()},
                      {of::workbench_fit_js(), of::workbench_fit_js_sha256()},
                      {of::workbench_compare_js(), of::workbench_compare_js_sha256()},
                      {of::workbench_ask_js(), of::workbench_ask_js_sha256()},
                      {of::workbench_page_js(), of::workbench_page_js_sha256()}},
                     frames);
}

}  // namespace wearwell::workbench
