#pragma once

#include <CLI/CLI.hpp>

namespace wearwell {

/// `wearwell new TRADE DIR`: sets `exit_code` when it ran.
void add_new_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
