#pragma once

namespace CLI {
class App;
}

namespace wearwell::fatigue {

/// `wearwell fatigue` and its subcommands.
void add_fatigue_command(CLI::App& app, int& exit_code);

}  // namespace wearwell::fatigue
