#pragma once

#include <string>

#include "wearwell/monitor/monitor_config.h"

namespace wearwell::monitor {

/// Reads a broker from the table of a source, or from [publish]. Throws InputErrors.
BrokerSettings read_broker(const TomlReader& table, const std::string& usual_client);

}  // namespace wearwell::monitor
