#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/cli/clutch/command_parts.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/fleet/clickhouse_engine.h"
#include "wearwell/fleet/duckdb_engine.h"
#include "wearwell/fleet/postgres_engine.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/fleet_columns.h"
#include "wearwell/models/clutch/fleet_run.h"
#include "wearwell/present/progress_line.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/study/result_writer.h"

namespace wearwell::clutch {
namespace {

struct FleetOptions {
  std::filesystem::path result, output = "fleet-results", state;
  std::vector<std::string> engines = {"duckdb"}, files, columns;
  std::string table, prefix = "wearwell";
  std::vector<double> levels = {25, 50, 75, 100}, horizons, days;
  int threads = 0;
  long memory = 0;
  bool scatter_only = false, statements = false, read_only = false, skip_bad = false, json = false,
       quiet = false;
};

std::vector<std::unique_ptr<fleet::Engine>> engines_of(const FleetOptions& options,
                                                       const ResultFolder& folder) {
  std::vector<std::unique_ptr<fleet::Engine>> engines;
  for (const std::string& name : options.engines) {
    const bool duckdb = name == "duckdb";
    if (duckdb && options.engines.size() > 1)
      throw InputError("--engine duckdb does not combine with other engines; several databases do");
    if (duckdb && (options.files.empty() || !options.table.empty()))
      throw InputError("--engine duckdb reads files: give files and leave out --table");
    if (!duckdb && (!options.files.empty() || options.table.empty() || !options.state.empty()))
      throw InputError(
          "a database needs --table, and takes neither files nor --state: it stores its sums "
          "itself");
    if (options.read_only && !name.starts_with("postgres"))
      throw InputError(
          duckdb
              ? "--read-only is for databases; files are never changed, and sums are stored by "
                "--state alone"
              : "--read-only works with PostgreSQL alone; in ClickHouse the user needs the right "
                "to create tables");
    if (duckdb) {
      engines.push_back(fleet::duckdb_engine({.files = options.files,
                                              .unit = unit_column(options.columns),
                                              .state = options.state,
                                              .spill = folder.path().parent_path(),
                                              .threads = options.threads,
                                              .memory = options.memory,
                                              .skip_bad = options.skip_bad,
                                              .progress = options.statements}));
    } else if (name.starts_with("postgresql://") || name.starts_with("postgres://")) {
      engines.push_back(fleet::postgres_engine(name, options.table, options.read_only));
    } else if (fleet::is_clickhouse(name)) {
      engines.push_back(fleet::clickhouse_engine(name, options.table));
    } else {
      throw InputError(fmt::format(
          "--engine: '{}' is unknown; use 'duckdb', 'postgresql://...' or 'clickhouse://...'",
          printable(shortened(name.substr(0, name.find("://"))))));
    }
  }
  return engines;
}

/// A result of another model, with what works for it.
void refuse_other_models(const FleetOptions& options) {
  std::error_code ignored;
  if (std::filesystem::exists(options.result / "model.json", ignored) ||
      !std::filesystem::exists(options.result / "state.bin", ignored))
    return;
  const prognosis::CarriedState state = prognosis::read_state(options.result);
  const std::string result = printable(options.result.string());
  if (state.model != "formula")
    throw InputError(fmt::format(
        "{}: wearwell fleet needs a fitted clutch; this one is of model \"{}\", which has no SQL. "
        "Its "
        "units one by one, from readings as they come: wearwell new monitor hall-1 --from {}",
        result, printable(state.model), result));
  const std::string& engine = options.engines.front();
  const bool clickhouse = fleet::is_clickhouse(engine);
  const bool postgres = engine.starts_with("postgres");
  const std::string table = options.table.empty() ? "SCHEMA.TABLE" : printable(options.table);
  std::string columns;
  for (const std::string& each : options.columns) columns += fmt::format(" '{}'", printable(each));
  if (!columns.empty()) columns = " --columns" + columns;
  const std::string run = clickhouse ? "clickhouse-client --multiquery < wear.sql"
                          : postgres ? "psql URL -f wear.sql"
                                     : "duckdb DATABASE < wear.sql";
  throw InputError(fmt::format(
      "{}: wearwell fleet needs a fitted clutch; this one is of model \"formula\", which SQL "
      "computes for every row of a table: wearwell export sql {} --dialect {} --table {}{} > "
      "wear.sql && {}{}",
      result, result,
      clickhouse ? "clickhouse"
      : postgres ? "postgresql"
                 : "duckdb",
      table, columns, run,
      clickhouse || postgres
          ? ""
          : "; files become such a table by: create table readings as from 'readings.csv'"));
}

void run_fleet(const FleetOptions& options, int& exit_code) {
  refuse_overwriting({{"the result", options.result}},
                     {{"--output", options.output}, {"--state", options.state}});
  refuse_other_models(options);
  const IdentifiedModel model = read_identified_model(options.result);
  ResultFolder folder(options.output);
  const bool first = options.engines.front() == "duckdb" &&
                     (options.state.empty() || !std::filesystem::exists(options.state));
  const auto engines = engines_of(options, folder);
  std::vector<fleet::Engine*> all;
  for (const auto& each : engines) all.push_back(each.get());
  const Result result = [&] {
    ProgressLine line(!options.quiet && isatty(STDERR_FILENO) ? stderr : nullptr);
    const Monitor monitor{.progress = [&](const Step& step) { line.show(step); },
                          .threads = options.threads};
    return find_fleet(model, all,
                      {.columns = options.columns,
                       .files = options.files,
                       .prefix = options.prefix,
                       .first = first,
                       .read_only = options.read_only,
                       .skip_bad = options.skip_bad,
                       .replicates = !options.scatter_only,
                       .statements = options.statements,
                       .levels = options.levels,
                       .horizons = options.horizons,
                       .days = options.days},
                      monitor);
  }();
  write_result(result, "", folder);
  if (options.json) {
    fmt::print("{}", summary_text(result));
  } else if (!options.quiet) {
    fmt::print("{}Results are in {}\n", terminal_text(result, terminal_style()),
               folder.path().string());
  }
  exit_code = result.header.trusted ? 0 : 1;
}

}  // namespace

void add_fleet_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "fleet", "Wear of every clutch of a fleet, computed in the database that holds its cycles");
  const auto options = std::make_shared<FleetOptions>();
  command
      ->add_option("RESULT", options->result, "Folder that wearwell fit wrote, or its model.json")
      ->required();
  command->add_option(
      "FILES", options->files,
      "Cycles, as for wearwell clutch predict: Parquet or CSV files, or a quoted pattern");
  command
      ->add_option(
          "--engine", options->engines,
          "The engine: duckdb, or a database, postgresql://USER@HOST/DATABASE or "
          "clickhouse://USER@HOST:8123/DATABASE (clickhouses:// with TLS; HOST,HOST are replicas); "
          "several databases one after the other where units are distributed over them")
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_option("--table", options->table, "The table of cycles in a database: SCHEMA.TABLE");
  command
      ->add_option("--prefix", options->prefix,
                   "Prefix of the two tables that are created in a database: SCHEMA.PREFIX")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder for the results")
      ->capture_default_str();
  command
      ->add_option("--columns", options->columns,
                   "Names of unit, cycle, slip_speed, torque, temperature, closing_time, energy in "
                   "the files: NAME=COLUMN or NAME=COLUMN:UNIT; and time (dates or times) or "
                   "cycles_per_day for results in days")
      ->type_name("NAME=COLUMN:UNIT");
  command->add_option("--state", options->state,
                      "DuckDB database: continue from its sums and store the new sums in it");
  command->add_flag("--read-only", options->read_only,
                    "Create nothing in PostgreSQL: sum all cycles in one query, for a user who may "
                    "only read");
  command->add_flag("--skip-bad", options->skip_bad,
                    "Leave out rows without a unit or with impossible values, and report them and "
                    "how much they matter");
  command->add_option("--level", options->levels, "Wear levels in % of the worn-out volume")
      ->delimiter(',')
      ->check(number_between(1e-6, 1e6))
      ->capture_default_str();
  command
      ->add_option("--horizon", options->horizons,
                   "Horizons in cycles at which failures are counted (default: fractions of the "
                   "mean so far)")
      ->delimiter(',')
      ->check(number_between(0, 1e15));
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
  command->footer(
      "Example:\n  wearwell fleet study-results 'cycles/*.parquet' --state sums.duckdb -o "
      "fleet-results");
  command->callback([options, &exit_code] { run_fleet(*options, exit_code); });
}

}  // namespace wearwell::clutch
