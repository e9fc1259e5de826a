#pragma once

namespace CLI {
class App;
}

/// The subcommands of `wearwell clutch`, one file each.
namespace wearwell::clutch {

void add_design_command(CLI::App& clutch);
void add_simulate_command(CLI::App& clutch);
void add_features_command(CLI::App& clutch, int& exit_code);
void add_predict_command(CLI::App& clutch, int& exit_code);
void add_life_command(CLI::App& clutch);
void add_compare_command(CLI::App& clutch);

/// `sql` of the parent.
CLI::App* add_sql_command(CLI::App& parent);

}  // namespace wearwell::clutch
