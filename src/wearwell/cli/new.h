#pragma once

#include "wearwell/study/model.h"

namespace CLI {
class App;
}

namespace wearwell {

/// `wearwell new APPLICATION DIR`: sets `exit_code` when it ran.
void add_new_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
