#include "wearwell/models/clutch/commands.h"

#include <CLI/CLI.hpp>

#include "wearwell/models/clutch/command_parts.h"

namespace wearwell {

void add_clutch_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "clutch", "Dry clutches: plan and simulate rig tests, predict worn volume and life");
  command->require_subcommand(1);
  clutch::add_design_command(*command);
  clutch::add_simulate_command(*command);
  clutch::add_features_command(*command, exit_code);
  clutch::add_predict_command(*command, exit_code);
  clutch::add_life_command(*command);
  clutch::add_compare_command(*command);
  clutch::add_sql_command(*command);
  clutch::add_sql_command(app)->group("");  // its name before it was one of clutch's
  clutch::add_fleet_command(app, exit_code);
}

}  // namespace wearwell
