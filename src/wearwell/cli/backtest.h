#pragma once

#include <CLI/CLI.hpp>

#include "wearwell/study/model.h"

namespace wearwell {

/// wearwell backtest: the coverage of forecasts for units whose end is known.
void add_backtest_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
