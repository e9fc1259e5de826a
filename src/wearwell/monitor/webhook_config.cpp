#include "wearwell/monitor/webhook_config.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/config_values.h"

namespace wearwell::monitor {
namespace {

void read_webhook_url(const TomlReader& table, WebhookSettings& webhook) {
  webhook.url = table.required_text("url");
  webhook.tls = webhook.url.starts_with("https://");
  if (!webhook.tls && !webhook.url.starts_with("http://"))
    table.fail("url", "is not a URL like https://HOST/PATH");
  const std::string rest = webhook.url.substr(webhook.tls ? 8 : 7);
  const std::size_t slash = std::min(rest.find_first_of("/?"), rest.size());
  if (rest.substr(0, slash).find('@') != std::string::npos)
    table.fail("url", "has a user; use token_file");
  const HostAndPort address =
      read_address(table, "url", rest.substr(0, slash), webhook.tls ? 443 : 80);
  webhook.host = address.host;
  webhook.port = fmt::format("{}", address.port);
  webhook.target = rest.substr(slash);
  if (!webhook.target.starts_with('/')) webhook.target = "/" + webhook.target;
  const bool plain = std::all_of(webhook.target.begin(), webhook.target.end(),
                                 [](char c) { return c > ' ' && c < '\x7f' && c != '#'; });
  if (!plain) table.fail("url", "has characters that must be percent-encoded");
}

void read_webhook_token(const TomlReader& table, bool has_url, WebhookSettings& webhook) {
  if (!table.has("token_file")) return;
  webhook.token = read_secret(table, "token_file");
  const bool visible = std::all_of(webhook.token.begin(), webhook.token.end(),
                                   [](char c) { return c > ' ' && c < '\x7f'; });
  if (!visible) table.fail("token_file", "has characters that no header can carry");
  if (has_url && !webhook.tls && !is_loopback(webhook.host))
    table.fail("token_file", "would be sent unencrypted; use https://");
}

}  // namespace

WebhookSettings read_webhook(const TomlReader& table) {
  WebhookSettings webhook;
  Problems problems;
  const bool has_url = problems.in([&] { read_webhook_url(table, webhook); },
                                   "url = \"https://alarms.example/wear\"");
  problems.in([&] { read_webhook_token(table, has_url, webhook); },
              "token_file = \"alarms.token\", a file with the token alone");
  problems.in(
      [&] {
        const auto after = table.quantity("after", "s");
        if (!after) return;
        constexpr double longest = 7 * 86400;
        if (!(after->si() >= 0 && after->si() <= longest))
          table.fail("after", "must lie between 0 s and 7 d");
        webhook.lasting = std::chrono::milliseconds(std::llround(1000 * after->si()));
      },
      "after = \"1 min\"");
  problems.finish();
  return webhook;
}

}  // namespace wearwell::monitor
