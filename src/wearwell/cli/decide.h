#pragma once

#include <CLI/CLI.hpp>

#include "wearwell/study/model.h"

namespace wearwell {

/// wearwell decide: minimizes cost, given distributions of life.
void add_decide_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
