#include "wearwell/monitor/fleet_page.h"

#include <fmt/format.h>

#include <string_view>

#include "wearwell/monitor/page_resources.h"

namespace wearwell::monitor {
namespace {

constexpr std::string_view sign_out =
    R"(<footer><form method="post" action="/logout"><button>Sign out</button></form></footer>
)";

constexpr std::string_view login_body = R"(<main class="login">
<h1>wearwell monitor</h1>
<form method="post" action="/login">
<label for="token">Token</label>
<input id="token" name="token" type="password" required autocomplete="current-password">
{}<button>Sign in</button>
</form>
</main>
)";

}  // namespace

ServedPage fleet_page(bool token) {
  namespace of = resource;
  std::string body(of::monitor_html());
  if (token) body += sign_out;
  return served_page("wearwell monitor", body,
                     {page_style(), {of::monitor_css(), of::monitor_css_sha256()}},
                     {page_words(),
                      {of::monitor_words_js(), of::monitor_words_js_sha256()},
                      {of::monitor_plot_js(), of::monitor_plot_js_sha256()},
                      {of::monitor_list_js(), of::monitor_list_js_sha256()},
                      {of::monitor_events_js(), of::monitor_events_js_sha256()},
                      {of::monitor_fits_js(), of::monitor_fits_js_sha256()},
                      {of::monitor_detail_js(), of::monitor_detail_js_sha256()},
                      {of::monitor_live_js(), of::monitor_live_js_sha256()}});
}

ServedPage login_page(bool wrong) {
  const char* note = wrong ? "<p class=\"wrong\" role=\"alert\">This is not the token.</p>\n" : "";
  return served_page("wearwell monitor: sign in", fmt::format(login_body, note),
                     {page_style(), {resource::monitor_css(), resource::monitor_css_sha256()}}, {});
}

}  // namespace wearwell::monitor
