#pragma once

#include <CLI/CLI.hpp>

namespace wearwell::bearing {

/// Adds `chart`: wear number against depth for several clearances, as CSV.
void add_chart_command(CLI::App& bearing);

}  // namespace wearwell::bearing
