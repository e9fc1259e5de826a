#pragma once

#include <CLI/CLI.hpp>

namespace wearwell {

/// `wearwell select DATA`: sets `exit_code` when it ran.
void add_select_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
