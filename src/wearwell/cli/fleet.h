#pragma once

#include "wearwell/study/model.h"

namespace CLI {
class App;
}

namespace wearwell {

/// wearwell fleet
void add_fleet_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
