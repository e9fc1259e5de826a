#pragma once

#include "wearwell/http/settings.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::monitor {

/// Reads [http]. Throws InputErrors.
HttpSettings read_http(const TomlReader& table);

}  // namespace wearwell::monitor
