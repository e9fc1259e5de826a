#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/cli/clutch/command_parts.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_sql.h"
#include "wearwell/models/clutch/fleet_columns.h"

namespace wearwell::clutch {
namespace {

struct SqlOptions {
  std::filesystem::path result;
  std::string dialect, table, prefix = "wearwell", part = "all";
  std::vector<std::string> columns;
  bool scatter_only = false;
};

void run_sql(const SqlOptions& options) {
  if (std::filesystem::exists(options.result / "state.bin") &&
      !std::filesystem::exists(options.result / "model.json"))
    throw InputError(fmt::format(
        "{} is not of a clutch; to print a study of model \"formula\" use: wearwell export sql",
        options.result.string()));
  const IdentifiedModel read = read_identified_model(options.result);
  const fleet::Dialect dialect = fleet::read_dialect(options.dialect);
  SqlSource source;
  source.table = fleet::table_identifier(dialect, options.table);
  source.prefix = options.prefix;
  read_fleet_columns(options.columns, {}, options.table, source);
  const ClutchSql sql = clutch_sql(read.model, read.id, dialect, source, !options.scatter_only);
  const auto wanted = [&](const char* part) {
    return options.part == "all" || options.part == part;
  };
  const std::string head =
      fleet::comment(fmt::format("wearwell {}: clutch wear of the units in {}, for {}; model {}",
                                 WEARWELL_VERSION, options.table, options.dialect, read.id));
  fmt::print("{}", head);
  if (wanted("setup")) {
    // ClickHouse has no transactions.
    const bool whole = dialect != fleet::Dialect::clickhouse;
    fmt::print("{}{}{}", whole ? "begin;\n" : "", sql.setup, whole ? "commit;\n" : "");
  }
  if (wanted("query")) fmt::print("{}", sql.query);
  if (wanted("combine")) fmt::print("{}", sql.combine);
}

}  // namespace

CLI::App* add_sql_command(CLI::App& parent) {
  CLI::App* command = parent.add_subcommand(
      "sql", "Print a fitted clutch as SQL for the database that holds a fleet's cycles");
  const auto options = std::make_shared<SqlOptions>();
  command
      ->add_option("RESULT", options->result, "Folder that wearwell fit wrote, or its model.json")
      ->required();
  command->add_option("--dialect", options->dialect, "SQL dialect of the database")
      ->required()
      ->check(one_of(fleet::dialect_names()));
  command
      ->add_option(
          "--table", options->table,
          "Table that holds the cycles: SCHEMA.TABLE; a part in double quotes may hold dots")
      ->required();
  command
      ->add_option("--columns", options->columns,
                   "unit, cycle, slip_speed, torque, temperature, closing_time, energy: each "
                   "NAME=COLUMN:UNIT")
      ->type_name("NAME=COLUMN:UNIT");
  command
      ->add_option("--prefix", options->prefix,
                   "Prefix of the two tables that the statements create: SCHEMA.PREFIX")
      ->capture_default_str();
  command->add_option("--part", options->part, "Print only one of the three statements")
      ->check(one_of({"all", "setup", "query", "combine"}))
      ->capture_default_str();
  command->add_flag("--scatter-only", options->scatter_only,
                    "Only the paper's interval, from the scatter of cycles; much faster");
  command->footer(
      "Example:\n  wearwell clutch sql study-results --dialect postgresql --table fleet.cycles "
      "--columns "
      "unit=vin cycle=cycle \\\n    'slip_speed=n:rpm' 'torque=m:N m' 'temperature=temp:degC' "
      "'closing_time=t:ms' 'energy=e:kJ' > wear.sql");
  command->callback([options] { run_sql(*options); });
  return command;
}

}  // namespace wearwell::clutch
