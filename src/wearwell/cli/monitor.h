#pragma once

#include "wearwell/study/model.h"

namespace CLI {
class App;
}

namespace wearwell {

/// `wearwell monitor CONFIG.toml`.
void add_monitor_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
