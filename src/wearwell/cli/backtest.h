#pragma once

#include <CLI/CLI.hpp>

#include "wearwell/study/model.h"

namespace wearwell {

/// wearwell backtest: how often forecasts of units that were followed have held.
void add_backtest_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
