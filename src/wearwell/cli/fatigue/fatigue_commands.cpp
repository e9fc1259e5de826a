#include "wearwell/cli/fatigue/fatigue_commands.h"

#include <CLI/CLI.hpp>

#include "wearwell/cli/fatigue/command_parts.h"

namespace wearwell::fatigue {

void add_fatigue_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "fatigue", "Fatigue under load histories: rainflow counts, damage and life; design curves");
  command->require_subcommand(1);
  add_rainflow_command(*command);
  add_life_command(*command, exit_code);
  add_design_command(*command, exit_code);
}

}  // namespace wearwell::fatigue
