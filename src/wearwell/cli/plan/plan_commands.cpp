#include "wearwell/cli/plan/plan_commands.h"

#include <CLI/CLI.hpp>

#include "wearwell/cli/plan/command_parts.h"

namespace wearwell::plan {

void add_plan_command(CLI::App& app, Models models, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("plan", "Plan tests and inspections: which next, how many, how long");
  command->require_subcommand(1);
  add_next_command(*command, models, exit_code);
  add_size_command(*command, models, exit_code);
  add_demonstrate_command(*command, exit_code);
  add_accelerate_command(*command, exit_code);
  add_inspect_command(*command, models, exit_code);
}

}  // namespace wearwell::plan
