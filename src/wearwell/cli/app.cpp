#include "wearwell/cli/app.h"

#include <map>
#include <string>

#include "wearwell/cli/backtest.h"
#include "wearwell/cli/bearing/bearing_commands.h"
#include "wearwell/cli/check.h"
#include "wearwell/cli/clutch/clutch_commands.h"
#include "wearwell/cli/compare.h"
#include "wearwell/cli/decide.h"
#include "wearwell/cli/fatigue/fatigue_commands.h"
#include "wearwell/cli/fit.h"
#include "wearwell/cli/fleet.h"
#include "wearwell/cli/formula/export_command.h"
#include "wearwell/cli/generate.h"
#include "wearwell/cli/help.h"
#include "wearwell/cli/life.h"
#include "wearwell/cli/monitor.h"
#include "wearwell/cli/new.h"
#include "wearwell/cli/open.h"
#include "wearwell/cli/plan/plan_commands.h"
#include "wearwell/cli/report.h"
#include "wearwell/cli/returns.h"
#include "wearwell/cli/select.h"
#include "wearwell/cli/update.h"

namespace wearwell {
namespace {

// The heading of the help under which a command stands.
void group_commands(CLI::App& app) {
  static const std::map<std::string, const char*> groups = {
      {"open", "A study"},       {"new", "A study"},       {"check", "A study"},
      {"fit", "A study"},        {"report", "A study"},    {"life", "Its result"},
      {"decide", "Its result"},  {"update", "Its result"}, {"backtest", "Its result"},
      {"compare", "Its result"}, {"export", "Its result"}, {"plan", "Its result"},
      {"monitor", "Many units"}, {"fleet", "Many units"},  {"returns", "Many units"},
      {"select", "Other"},       {"help", "Other"},        {"version", "Other"}};
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty()) continue;
    const auto group = groups.find(command->get_name());
    command->group(group == groups.end() ? "Applications" : group->second);
  }
}

}  // namespace

std::unique_ptr<CLI::App> make_app(Models models, int& exit_code) {
  auto app = std::make_unique<CLI::App>(
      "Wear and fatigue-life parameters from few noisy measurements, with honest uncertainty.",
      "wearwell");
  app->require_subcommand(1);
  app->set_version_flag("--version", WEARWELL_VERSION, "Print the version and exit");
  add_open_command(*app, models, exit_code);
  add_new_command(*app, models, exit_code);
  add_check_command(*app, models, exit_code);
  add_fit_command(*app, models, exit_code);
  add_report_command(*app, exit_code);
  add_life_command(*app, models, exit_code);
  add_decide_command(*app, models, exit_code);
  plan::add_plan_command(*app, models, exit_code);
  add_update_command(*app, models, exit_code);
  add_backtest_command(*app, models, exit_code);
  add_compare_command(*app, models, exit_code);
  add_monitor_command(*app, models, exit_code);
  bearing::add_bearing_command(*app);
  clutch::add_clutch_commands(*app, exit_code);
  add_fleet_command(*app, models, exit_code);
  add_returns_command(*app, exit_code);
  fatigue::add_fatigue_command(*app, exit_code);
  formula_model::add_export_command(*app, exit_code);
  add_select_command(*app, exit_code);
  add_help_command(*app, exit_code);
  add_version_command(*app, exit_code);
  add_generate_command(*app, exit_code);
  group_commands(*app);
  // Set last: commands added later would inherit it.
  app->footer(
      "wearwell help COMMAND describes a command; wearwell new JOB DIR writes a first study.");
  return app;
}

}  // namespace wearwell
