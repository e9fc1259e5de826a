#pragma once

namespace CLI {
class App;
}

namespace wearwell {

/// `wearwell compare DIR DIR ...`: sets `exit_code` when it ran.
void add_compare_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
