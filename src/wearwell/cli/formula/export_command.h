#pragma once

#include <CLI/CLI.hpp>

namespace wearwell::formula_model {

/// wearwell export c: the tracker of one unit as C99.
void add_export_command(CLI::App& app, int& exit_code);

}  // namespace wearwell::formula_model
