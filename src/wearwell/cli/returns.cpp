#include "wearwell/cli/returns.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/base/shell_word.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/cli/fleet_options.h"
#include "wearwell/in_service/sold_units.h"
#include "wearwell/input/month_text.h"

namespace wearwell {
namespace {

struct ReturnsOptions {
  FleetOptions source;
  std::string until;
};

int last_month(const std::string& text) {
  const auto month = month_in(text);
  if (!month)
    throw InputError(
        fmt::format("--until: '{}' is no month; write the last month that the table "
                    "covers, for example 2025-12",
                    printable(text)));
  return *month;
}

std::string units_text(double count) {
  return fmt::format("{:.0f} unit{}", count, count == 1 ? "" : "s");
}

void print_counts(const in_service::SoldUnits& units, int until, const FleetOptions& source) {
  double sold = 0, returned = 0;
  for (const auto& [month, count] : units.sold) sold += count;
  for (const auto& [mode, returns] : units.returned)
    for (const auto& [months, count] : returns.units) returned += count;
  const std::string end = month_text(until);
  fmt::print("{} sold from {} to {}, {:.0f} returned until {}\n", units_text(sold),
             month_text(units.sold.begin()->first), month_text(units.sold.rbegin()->first),
             returned, end);
  if (units.late_sales > 0)
    fmt::print("Left out: {} sold after {}\n", units_text(units.late_sales), end);
  if (units.late_returns > 0)
    fmt::print("In use: {} returned after {}\n", units_text(units.late_returns), end);
  fmt::print("Returns triangle in {0}\nNow run: wearwell new STUDY --from {0}\n",
             shell_word(source.output.string()));
}

int run_returns(ReturnsOptions& options) {
  FleetOptions& source = options.source;
  const int until = last_month(options.until);
  const in_service::SoldColumns columns = in_service::read_sold_columns(source.columns);
  std::vector<NamedFile> inputs;
  for (const std::string& each : source.files) inputs.push_back({"the table", each});
  refuse_overwriting(inputs, {{"--output", source.output}});
  source.read_only = source.engines.front().starts_with("postgres");  // it creates nothing
  in_service::SoldUnits units;
  for (const auto& engine :
       engines_of(source, "", std::filesystem::absolute(source.output).parent_path()))
    in_service::count_sold_units(*engine, columns, until, units);
  write_file(source.output,
             present::csv(in_service::returns_table(units, !columns.mode.empty(), until)));
  if (!source.quiet) print_counts(units, until, source);
  return 0;
}

}  // namespace

void add_returns_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("returns", "Count units sold and returned by month, where their data are");
  const auto options = std::make_shared<ReturnsOptions>();
  FleetOptions& source = options->source;
  source.output = "returns.csv";
  command->add_option("FILES", source.files,
                      "Units sold, one row each with its dates: Parquet or CSV files, or a quoted "
                      "pattern");
  command
      ->add_option("--engine", source.engines,
                   "The engine: duckdb, or a database, postgresql://USER@HOST/DATABASE or "
                   "clickhouse://USER@HOST:8123/DATABASE; several databases one after the other "
                   "where units are distributed over them")
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_option("--table", source.table,
                      "The table or view of units in a database: SCHEMA.TABLE");
  command
      ->add_option("--columns", source.columns,
                   "Columns of sold (date of sale), returned (date of return, null for a unit that "
                   "did not come back), quantity (units of a row) and mode (failure mode): "
                   "NAME=COLUMN")
      ->required()
      ->type_name("NAME=COLUMN");
  command
      ->add_option("--until", options->until,
                   "The last month that the table covers, such as 2025-12; later returns do not "
                   "count")
      ->required()
      ->type_name("MONTH");
  command->add_option("-o,--output", source.output, "File for the returns triangle (CSV)")
      ->capture_default_str();
  command->add_option("--memory", source.memory, "Memory limit of DuckDB in MB (default: half)")
      ->check(CLI::Range(100L, 100'000'000L));
  command->add_option("--threads", source.threads, "Threads of DuckDB (default: all)")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--quiet", source.quiet, "Print nothing but errors");
  command->footer(
      "Examples:\n"
      "  wearwell returns --engine postgresql://reader@db1/sales --table pumps --until 2025-12 \\\n"
      "    --columns sold=sale_date returned=failure_date\n"
      "  wearwell returns 'units/*.parquet' --columns sold=sale_date returned=failure_date "
      "mode=cause --until 2025-12");
  command->callback([options, &exit_code] { exit_code = run_returns(*options); });
}

}  // namespace wearwell
