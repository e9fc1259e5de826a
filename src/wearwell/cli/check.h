#pragma once

#include <CLI/CLI.hpp>

namespace wearwell {

/// `wearwell check STUDY.toml`: sets `exit_code` when it ran.
void add_check_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
