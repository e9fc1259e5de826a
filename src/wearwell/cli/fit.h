#pragma once

#include <CLI/CLI.hpp>

#include "wearwell/study/model.h"

namespace wearwell {

/// `wearwell fit STUDY.toml`: sets `exit_code` when it ran.
void add_fit_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
