#pragma once

namespace CLI {
class App;
}

/// The subcommands of `wearwell fatigue`, one file each.
namespace wearwell::fatigue {

void add_rainflow_command(CLI::App& fatigue);
void add_life_command(CLI::App& fatigue, int& exit_code);
void add_design_command(CLI::App& fatigue, int& exit_code);

}  // namespace wearwell::fatigue
