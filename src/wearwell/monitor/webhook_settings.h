#pragma once

#include <chrono>
#include <string>

namespace wearwell::monitor {

/// Where alarms are sent: [webhook].
struct WebhookSettings {
  std::string url;  ///< for messages
  std::string host, port, target;
  bool tls = false;
  std::string token = {};                     ///< Authorization: Bearer; empty: none
  std::chrono::milliseconds lasting{60'000};  ///< how long an alarm must last to be sent
};

}  // namespace wearwell::monitor
