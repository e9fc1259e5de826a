#include "wearwell/cli/clutch/clutch_commands.h"

#include <CLI/CLI.hpp>

#include "wearwell/cli/clutch/command_parts.h"

namespace wearwell::clutch {

void add_clutch_commands(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "clutch", "Dry clutches: plan and simulate rig tests, predict worn volume and life");
  command->require_subcommand(1);
  add_design_command(*command);
  add_simulate_command(*command);
  add_features_command(*command, exit_code);
  add_predict_command(*command, exit_code);
  add_life_command(*command);
  add_compare_command(*command);
  add_sql_command(*command);
  add_sql_command(app)->group("");  // the name before the command moved to clutch
}

}  // namespace wearwell::clutch
