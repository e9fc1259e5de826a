#pragma once

#include <CLI/CLI.hpp>

#include "wearwell/study/model.h"

namespace wearwell {

/// `wearwell life`: the remaining useful life of one unit of a result (docs/how-to/state.md).
void add_life_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
