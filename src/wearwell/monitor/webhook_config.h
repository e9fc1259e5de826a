#pragma once

#include "wearwell/input/toml_reader.h"
#include "wearwell/monitor/webhook_settings.h"

namespace wearwell::monitor {

/// Reads [webhook]. Throws InputErrors.
WebhookSettings read_webhook(const TomlReader& table);

}  // namespace wearwell::monitor
