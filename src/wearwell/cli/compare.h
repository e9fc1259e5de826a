#pragma once

#include "wearwell/study/model.h"

namespace CLI {
class App;
}

namespace wearwell {

/// `wearwell compare DIR DIR ...` and `wearwell compare STUDY --families NAMES`: sets `exit_code` when
/// it ran.
void add_compare_command(CLI::App& app, Models models, int& exit_code);

}  // namespace wearwell
