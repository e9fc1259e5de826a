#pragma once

#include <CLI/CLI.hpp>

namespace wearwell {

/// `wearwell fit STUDY.toml`: sets `exit_code` when it ran.
void add_fit_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
