#pragma once

#include <CLI/CLI.hpp>

namespace wearwell {

/// `wearwell generate man|bash|zsh`, which `cmake --install` runs: the manual page and what shells
/// complete. Hidden from help.
void add_generate_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
