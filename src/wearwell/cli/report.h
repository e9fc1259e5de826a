#pragma once

namespace CLI {
class App;
}

namespace wearwell {

/// `wearwell report DIR`: sets `exit_code` when it ran.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
