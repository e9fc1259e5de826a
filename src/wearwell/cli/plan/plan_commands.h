#pragma once

#include "wearwell/study/model.h"

namespace CLI {
class App;
}

namespace wearwell::plan {

/// `wearwell plan` and its subcommands.
void add_plan_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell::plan
