#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/fleet/duckdb_engine.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/command_parts.h"
#include "wearwell/models/clutch/fleet_columns.h"
#include "wearwell/models/clutch/fleet_report.h"
#include "wearwell/present/progress_line.h"
#include "wearwell/study/result_writer.h"

namespace wearwell::clutch {
namespace {

struct FleetOptions {
  std::filesystem::path result, output = "fleet-results", state;
  std::string engine = "duckdb";
  std::vector<std::string> files, columns;
  std::vector<double> levels = {25, 50, 75, 100}, horizons;
  int threads = 0;
  long memory = 0;
  bool scatter_only = false, json = false, quiet = false;
};

/// What a look at all rows tells before they are summed.
struct FleetCheck {
  double rows = 0;
};

/// Throws InputError for rows that no sum can take.
FleetCheck check_rows(fleet::Engine& engine, const ClutchSql& sql) {
  FleetCheck check;
  engine.rows(sql.check, 0, [&](const fleet::Row& row) {
    check.rows = row.numbers[0];
    const double refused = row.numbers[1], nameless = row.numbers[2];
    if (check.rows == 0) throw InputError(fmt::format("{} has no rows", engine.source()));
    if (nameless > 0)
      throw InputError(fmt::format("{}: {:.0f} rows name no unit", engine.source(), nameless));
    if (refused > 0)
      throw InputError(fmt::format(
          "{}: {:.0f} rows of {:.0f} have no value, or one that cannot be: cycles are whole "
          "numbers of "
          "at least 1, temperatures above absolute zero, all else positive (least and most: "
          "slip_speed "
          "{:.6g} .. {:.6g} rad/s, torque {:.6g} .. {:.6g} N m, temperature {:.6g} .. {:.6g} degC, "
          "closing_time {:.6g} .. {:.6g} s)",
          engine.source(), refused, check.rows, row.numbers[3], row.numbers[4], row.numbers[5],
          row.numbers[6], row.numbers[7], row.numbers[8], row.numbers[9], row.numbers[10]));
  });
  return check;
}

void refuse_late(fleet::Engine& engine, const ClutchSql& sql) {
  engine.rows(sql.late, 1, [&](const fleet::Row& row) {
    throw InputError(
        fmt::format("{}: unit {} has {:.0f} cycles up to the last one that was counted, of which "
                    "{:.0f} were counted: "
                    "rows came late or went; sum them all anew, without --state",
                    engine.source(), printable(row.texts.front()), row.numbers[0], row.numbers[1]));
  });
}

void refuse_repeated(const fleet::Engine& engine, const UnitSums& sums) {
  if (sums.repeated > 0)
    throw InputError(fmt::format("{}: unit {} has {:.0f} cycles whose number stands there twice",
                                 engine.source(), printable(sums.unit), sums.repeated));
}

/// Now, and after parts of the mean number of cycles so far, in round numbers.
std::vector<double> horizons_of(double mean_cycles) {
  std::vector<double> horizons = {0};
  for (const double share : {0.25, 0.5, 1.0}) {
    const double n = share * mean_cycles, digit = std::pow(10, std::floor(std::log10(n)));
    const double rounded = std::max(1.0, std::round(n / digit) * digit);
    if (rounded > horizons.back()) horizons.push_back(rounded);
  }
  return horizons;
}

Result find(const FleetOptions& options, const IdentifiedModel& model, fleet::Engine& engine,
            bool first, const Monitor& monitor) {
  const bool full = !options.scatter_only && !model.model.replicates.empty();
  SqlSource source;
  source.table = engine.table();
  source.first = first;
  read_fleet_columns(options.columns, engine.columns(), engine.source(), source);
  const ClutchSql sql = clutch_sql(model.model, model.id, engine.dialect(), source, full);
  const auto start = std::chrono::steady_clock::now();
  const FleetCheck check = check_rows(engine, sql);
  engine.run("begin transaction", {}, "", 0);
  engine.run(sql.setup, {}, "", 0);
  if (!first) refuse_late(engine, sql);
  engine.run(sql.query, monitor, "cycles", static_cast<long long>(check.rows));
  FleetFindings found{
      .version = WEARWELL_VERSION,
      .model_id = model.id,
      .engine = engine.in_words(),
      .source = engine.source(),
      .files = options.files,
      .rows = check.rows,
      .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
      .replicates = full,
      .units = {},
      .statements = sql.setup + sql.query};
  std::vector<double> horizons = options.horizons, levels;
  const std::size_t replicates = full ? model.model.replicates.size() : 0;
  if (horizons.empty()) {
    double units = 0, cycles = 0;
    engine.rows(sql.size, 0, [&](const fleet::Row& row) {
      units = row.numbers[0];
      cycles = row.numbers[1];
    });
    horizons = horizons_of(cycles / units);
  } else if (horizons.front() != 0) {
    horizons.insert(horizons.begin(), 0);
  }
  for (const double percent : options.levels) levels.push_back(percent / 100);
  FleetCounts counts(model.model, full, levels, horizons);
  engine.rows(sql.totals, 1, [&](const fleet::Row& row) {
    const UnitSums sums = unit_sums(row, replicates);
    refuse_repeated(engine, sums);
    found.units.push_back(counts.add(sums));
  });
  worst_first(found.units);
  return fleet_result(model.model, counts, found);
}

void run_fleet(const FleetOptions& options, int& exit_code) {
  if (options.engine != "duckdb")
    throw InputError(fmt::format("--engine: '{}' is not 'duckdb'", printable(options.engine)));
  refuse_overwriting({{"the result", options.result}},
                     {{"--output", options.output}, {"--state", options.state}});
  const IdentifiedModel model = read_identified_model(options.result);
  ResultFolder folder(options.output);
  const bool first = options.state.empty() || !std::filesystem::exists(options.state);
  const auto engine = fleet::duckdb_engine({.files = options.files,
                                            .unit = unit_column(options.columns),
                                            .state = options.state,
                                            .spill = folder.path().parent_path(),
                                            .threads = options.threads,
                                            .memory = options.memory});
  ProgressLine line(!options.quiet && isatty(STDERR_FILENO) ? stderr : nullptr);
  const Monitor monitor{.progress = [&](const Step& step) { line.show(step); },
                        .threads = options.threads};
  const Result result = find(options, model, *engine, first, monitor);
  engine->run("commit", {}, "", 0);
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
      "fleet", "Wear of every unit of a fleet, computed where its cycles lie (clutches)");
  const auto options = std::make_shared<FleetOptions>();
  command
      ->add_option("RESULT", options->result, "folder that wearwell fit wrote, or its model.json")
      ->required();
  command
      ->add_option(
          "FILES", options->files,
          "cycles, as for wearwell clutch predict: Parquet or CSV files, or a pattern in quotes")
      ->required();
  command->add_option("--engine", options->engine, "that computes")->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder for the results")
      ->capture_default_str();
  command
      ->add_option(
          "--columns", options->columns,
          "unit, cycle, slip_speed, torque, temperature, closing_time, energy: NAME=COLUMN "
          "or NAME=COLUMN:UNIT, where files call them otherwise")
      ->type_name("NAME=COLUMN:UNIT");
  command->add_option("--state", options->state,
                      "a database of DuckDB: go on from the sums in it, and leave the sums in it");
  command->add_option("--level", options->levels, "wear levels in % of the worn-out volume")
      ->delimiter(',')
      ->check(number_between(1e-6, 1e6))
      ->capture_default_str();
  command
      ->add_option(
          "--horizon", options->horizons,
          "further cycles after which units are counted (default: parts of the mean so far)")
      ->delimiter(',')
      ->check(number_between(0, 1e15));
  command->add_flag("--scatter-only", options->scatter_only,
                    "without what is not known of map and run-in; much faster");
  command->add_option("--memory", options->memory, "MB that DuckDB may take (default: half)")
      ->check(CLI::Range(100L, 100'000'000L));
  command
      ->add_option("--threads", options->threads,
                   "threads (default: all); results do not depend on it")
      ->check(CLI::Range(1, 1024));
  CLI::Option* json =
      command->add_flag("--json", options->json, "print summary.json and nothing else");
  command->add_flag("--quiet", options->quiet, "print nothing but errors")->excludes(json);
  command->footer(
      "Example:\n  wearwell fleet study-results 'cycles/*.parquet' --state sums.duckdb -o "
      "fleet-results");
  command->callback([options, &exit_code] { run_fleet(*options, exit_code); });
}

}  // namespace wearwell::clutch
