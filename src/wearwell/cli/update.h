#pragma once

#include <CLI/CLI.hpp>

#include "wearwell/study/model.h"

namespace wearwell {

/// `wearwell update`: fits a result's data and new data together (docs/how-to/state.md).
void add_update_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
