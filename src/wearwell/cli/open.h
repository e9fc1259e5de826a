#pragma once

#include <CLI/CLI.hpp>

#include "wearwell/study/model.h"

namespace wearwell {

/// `wearwell open`: the workbench, a page in the browser (docs/how-to/workbench.md).
void add_open_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
