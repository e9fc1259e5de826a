#include "wearwell/cli/fleet.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/cli/clutch/fleet_command.h"
#include "wearwell/cli/fleet_options.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/in_service/lives_fleet.h"
#include "wearwell/in_service/unit_columns.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell {
namespace {

bool is_clutch(const std::filesystem::path& result) {
  std::error_code ignored;
  return std::filesystem::exists(result / "model.json", ignored) ||
         !std::filesystem::exists(result / "state.bin", ignored);
}

// Options that have no meaning for units with ages.
void refuse_clutch_options(const FleetOptions& options) {
  const std::pair<const char*, const char*> reasons[] = {
      {"--level", "a life has no wear levels"},
      {"--state",
       "a table of units in service holds them as they are now; there are no sums to keep"},
      {"--days", "write the horizon with its unit: --horizon '30 day'"},
      {"--scatter-only", "the uncertainty of the population is always included, and costs no time"},
      {"--statements", "lives are computed by the program, not by statements"},
      {"--prefix", "no table is created"}};
  for (const auto& [option, reason] : reasons)
    if (options.has(option))
      throw InputError(fmt::format("{}: is for clutches; {}", option, reason));
}

int run_lives_fleet(FleetOptions options, Models models) {
  refuse_clutch_options(options);
  const bool postgres = options.engines.front().starts_with("postgres");
  options.read_only |= postgres;  // it creates nothing anyway
  const prognosis::CarriedState state = prognosis::read_state(options.result);
  ResultFolder folder(options.output);
  const auto engines = engines_of(options, in_service::unit_name_column(options.columns),
                                  folder.path().parent_path());
  std::vector<fleet::Engine*> all;
  for (const auto& each : engines) all.push_back(each.get());
  return show_fleet(options, folder, [&](const Monitor& monitor) {
    return in_service::fleet_of_lives(state, printable(options.result.string()), models, all,
                                      {.columns = options.columns,
                                       .files = options.files,
                                       .point = options.point,
                                       .horizons = options.horizons,
                                       .in_study = options.in_study,
                                       .skip_bad = options.skip_bad},
                                      monitor);
  });
}

int run_fleet(const FleetOptions& options, Models models) {
  refuse_overwriting({{"the result", options.result}},
                     {{"--output", options.output}, {"--state", options.state}});
  return is_clutch(options.result) ? clutch::run_clutch_fleet(options)
                                   : run_lives_fleet(options, models);
}

void add_inputs(CLI::App* command, const std::shared_ptr<FleetOptions>& options) {
  command
      ->add_option(
          "RESULT", options->result,
          "Folder that wearwell fit wrote: a clutch (or its model.json), lives, or wear to a "
          "failure threshold")
      ->required();
  command->add_option("FILES", options->files,
                      "Units in service, one row each with its age, or one for each reading of "
                      "wear or degradation; of a clutch its cycles, as for wearwell clutch "
                      "predict: Parquet or CSV files, or a quoted pattern");
  command
      ->add_option(
          "--engine", options->engines,
          "The engine: duckdb, or a database, postgresql://USER@HOST/DATABASE or "
          "clickhouse://USER@HOST:8123/DATABASE (clickhouses:// with TLS; HOST,HOST are replicas); "
          "several databases one after the other where units are distributed over them")
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_option("--table", options->table,
                      "The table or view of units (of cycles) in a database: SCHEMA.TABLE");
  command
      ->add_option("--prefix", options->prefix,
                   "Prefix of the two tables that are created in a database: SCHEMA.PREFIX")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder for the results")
      ->capture_default_str();
  command
      ->add_option(
          "--columns", options->columns,
          "Columns of unit, age, in_study, life and the study's conditions, or of unit and the "
          "study's columns: NAME=COLUMN or NAME=COLUMN:UNIT. Of a clutch those of unit, cycle, "
          "slip_speed, torque, "
          "temperature, closing_time, energy; and time (dates or times) or "
          "cycles_per_day for results in days")
      ->type_name("NAME=COLUMN:UNIT");
  command->add_option(
      "--state", options->state,
      "DuckDB database, of a clutch: continue from its sums and store the new sums in it");
  command->add_flag("--read-only", options->read_only,
                    "Create nothing in PostgreSQL: sum all cycles in one query, for a user who may "
                    "only read");
  command->add_flag("--skip-bad", options->skip_bad,
                    "Leave out rows without a unit or with impossible values, and report them and "
                    "how much they matter");
}

void add_questions(CLI::App* command, const std::shared_ptr<FleetOptions>& options) {
  command
      ->add_option("--level", options->levels,
                   "Wear levels of a clutch in % of the worn-out volume")
      ->delimiter(',')
      ->check(number_between(1e-6, 1e6))
      ->capture_default_str();
  command
      ->add_option("--horizon", options->horizons,
                   "Horizons at which failures are counted: '500 h' (default: fractions of the "
                   "median life); of a clutch numbers of cycles (default: fractions of the mean so "
                   "far)")
      ->delimiter(',');
  command->add_option("--at", options->point,
                      "Which life of [predict], for a study of several: 'softer spring'");
  command->add_flag("--in-study", options->in_study,
                    "The study has all these units as run-outs of their ages, so that their "
                    "survival is no new evidence on the population");
  command
      ->add_option("--days", options->days,
                   "Horizons in days at which failures are counted, with each unit's cycles per "
                   "day, where --columns has time or cycles_per_day (default there: 30, 90, 365)")
      ->delimiter(',')
      ->check(number_between(0, 1e6));
  command->add_flag("--scatter-only", options->scatter_only,
                    "Leave out the uncertainty of map and run-in; much faster");
  command->add_flag("--statements", options->statements,
                    "Run the statements of wearwell clutch sql in DuckDB, as in other engines, "
                    "instead of the built-in loop: the same numbers, much slower");
  command->add_option("--memory", options->memory, "Memory limit of DuckDB in MB (default: half)")
      ->check(CLI::Range(100L, 100'000'000L));
  command
      ->add_option("--threads", options->threads,
                   "Threads (default: all); results do not depend on the number")
      ->check(CLI::Range(1, 1024));
  CLI::Option* json =
      command->add_flag("--json", options->json, "Print summary.json and nothing else");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors")->excludes(json);
}

}  // namespace

void add_fleet_command(CLI::App& app, Models models, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "fleet",
      "Failures to come among units in service, or the wear of clutches, where their data are");
  const auto options = std::make_shared<FleetOptions>();
  add_inputs(command, options);
  add_questions(command, options);
  command->footer(
      "Examples:\n"
      "  wearwell fleet life-results units.csv --horizon '500 h,2000 h'\n"
      "  wearwell fleet life-results --engine postgresql://reader@db1/plant --table plant.pumps "
      "\\\n"
      "    --columns unit=serial 'age=run_time:h' 'temperature=t:degC' --in-study\n"
      "  wearwell fleet study-results 'cycles/*.parquet' --state sums.duckdb -o fleet-results");
  command->callback([command, options, models, &exit_code] {
    for (const CLI::Option* each : command->get_options())
      if (each->count() > 0) options->given.push_back(each->get_name());
    exit_code = run_fleet(*options, models);
  });
}

}  // namespace wearwell
