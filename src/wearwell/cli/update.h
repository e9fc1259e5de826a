#pragma once

#include <CLI/CLI.hpp>

#include "wearwell/study/model.h"

namespace wearwell {

/// `wearwell update`: a result and new data make the result of all data (docs/how-to/state.md).
void add_update_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
