#pragma once

#include <CLI/CLI.hpp>

namespace wearwell {

/// `wearwell help [COMMAND [SUBCOMMAND]]`, for all commands that `app` has when it runs.
void add_help_command(CLI::App& app, int& exit_code);

/// `wearwell version`.
void add_version_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
