#include "wearwell/monitor/broker_config.h"

#include <fmt/format.h>

#include "wearwell/input/text_file.h"
#include "wearwell/monitor/config_problems.h"
#include "wearwell/monitor/config_values.h"

namespace wearwell::monitor {

BrokerSettings read_broker(const TomlReader& table, const std::string& usual_client) {
  BrokerSettings broker;
  const auto read_url = [&] {
    const std::string url = table.required_text("broker");
    broker.tls = url.starts_with("mqtts://");
    if (!broker.tls && !url.starts_with("mqtt://"))
      table.fail("broker",
                 fmt::format("'{}' is not a URL like mqtt://HOST:PORT or mqtts://HOST:PORT", url));
    const std::string_view rest = std::string_view(url).substr(broker.tls ? 8 : 7);
    const HostAndPort address = read_address(table, "broker", rest, broker.tls ? 8883 : 1883);
    broker.host = address.host;
    broker.port = address.port;
  };
  Problems problems;
  const bool has_url = problems.in(read_url, "broker = \"mqtts://broker.example:8883\"");
  problems.in(
      [&] {
        broker.client = table.text("client").value_or(usual_client);
        if (broker.client.empty() || broker.client.size() > 100)
          table.fail("client", "must be of 1 to 100 bytes");
      },
      fmt::format("client = \"{}\"", usual_client));
  problems.in([&] { broker.user = table.text("user").value_or(""); }, "user = \"wearwell\"");
  problems.in(
      [&] {
        if (!table.has("password_file")) return;
        if (broker.user.empty())
          table.fail("password_file", "is a password without a user; add user = \"...\"");
        broker.password = read_text_file(existing(table, "password_file")).text;
        while (!broker.password.empty() && broker.password.back() == '\n')
          broker.password.pop_back();
      },
      "password_file = \"broker.password\" with user = \"wearwell\"");
  problems.in(
      [&] {
        if (!table.has("authority")) return;
        broker.authority = existing(table, "authority");
        if (has_url && !broker.tls) table.fail("authority", "needs a broker at mqtts://");
      },
      "authority = \"ca.pem\" with broker = \"mqtts://broker.example:8883\"");
  problems.in(
      [&] {
        broker.version5 = table.choice("protocol", {"5", "3.1.1"}).value_or("5") == "5";
      },
      "protocol = \"5\"");
  problems.finish();
  return broker;
}

}  // namespace wearwell::monitor
