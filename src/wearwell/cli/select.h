#pragma once

namespace CLI {
class App;
}

namespace wearwell {

/// `wearwell select DATA`: sets `exit_code` when it ran.
void add_select_command(CLI::App& app, int& exit_code);

}  // namespace wearwell
