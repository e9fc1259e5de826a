#include "wearwell/cli/formula/export_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/formula_model/c_export.h"
#include "wearwell/models/formula_model/sql_export.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/present/text_table.h"

namespace wearwell::formula_model {
namespace {

struct ExportOptions {
  std::filesystem::path result, output;
  CExportChoice choice;
};

int run_export(const ExportOptions& options) {
  const prognosis::CarriedState state = prognosis::read_state(options.result);
  if (state.model != "formula")
    throw InputError(fmt::format("{}: a study of model \"{}\" is not exported to C; \"formula\" is",
                                 options.result.string(), printable(state.model)));
  const CExport made = c_export(state, options.choice, WEARWELL_VERSION);
  const std::string& name = options.choice.name;
  ResultFolder folder(options.output);
  folder.write(name + "_unit.h", made.header);
  folder.write(name + "_unit.c", made.source);
  folder.write(name + "_test.c", made.test);
  folder.commit();
  fmt::print("{} nodes on {} lines, {:.0f} of them effective at the beginning\n", made.nodes,
             made.lines, made.effective);
  fmt::print("{}", text_table({{"", "bytes"},
                               {"  tables, read only", fmt::format("{}", made.table_bytes)},
                               {"  each unit", fmt::format("{}", made.unit_bytes)},
                               {"  scratch, one for all", fmt::format("{}", made.scratch_bytes)}}));
  fmt::print(
      "Now run: cd {0} && cc -std=c99 -O2 {1}_unit.c {1}_test.c -lm -o {1}_test && ./{1}_test\n",
      printable(options.output.string()), name);
  return state.trusted ? 0 : 1;
}

struct SqlOptions {
  std::filesystem::path result;
  std::string dialect, part = "all";
  SqlExportChoice choice;
};

int run_export_sql(SqlOptions& options) {
  const prognosis::CarriedState state = prognosis::read_state(options.result);
  if (state.model != "formula")
    throw InputError(
        fmt::format("{}: a study of model \"{}\" is not printed as SQL; \"formula\" is",
                    options.result.string(), printable(state.model)));
  options.choice.dialect = fleet::read_dialect(options.dialect);
  const SqlExport made = sql_export(state, options.choice);
  fmt::print("{}", fleet::comment(fmt::format("wearwell {}: {} [{}] of each row of {}, for {}",
                                              WEARWELL_VERSION, made.expression, made.unit,
                                              options.choice.table, options.dialect)));
  if (options.part != "query") {
    const bool whole = options.choice.dialect != fleet::Dialect::clickhouse;
    fmt::print("{}{}{}", whole ? "begin;\n" : "", made.setup, whole ? "commit;\n" : "");
  }
  if (options.part != "setup")
    fmt::print(
        "-- 2. Query: quantiles over the draws at 5, 50 and 95 %, each the mean of two order "
        "statistics; without the scatter of readings.\n{};\n",
        made.query);
  return state.trusted ? 0 : 1;
}

void add_sql(CLI::App& command, int& exit_code) {
  CLI::App* sql = command.add_subcommand(
      "sql", "As SQL: a value of the law with its interval, for every row of a table");
  const auto options = std::make_shared<SqlOptions>();
  sql->add_option("RESULT", options->result,
                  "folder that wearwell fit wrote of a model \"formula\"")
      ->required();
  sql->add_option("--dialect", options->dialect, "of the database")
      ->required()
      ->check(one_of(fleet::dialect_names()));
  sql->add_option("--table", options->choice.table,
                  "SCHEMA.TABLE; a part in double quotes may hold dots")
      ->required();
  sql->add_option("--value", options->choice.value,
                  "an expression of the law (default: what its first measured column is about)");
  sql->add_option("--unit", options->choice.unit, "of the answer");
  sql->add_option("--columns", options->choice.columns,
                  "of the table, where it calls them otherwise than the study's file, or has them "
                  "in other units: NAME=COLUMN:UNIT")
      ->type_name("NAME=COLUMN:UNIT");
  sql->add_option("--keep", options->choice.keep, "further columns of the table, for the answer")
      ->delimiter(',');
  sql->add_option("--prefix", options->choice.prefix, "of the table of draws that is made")
      ->capture_default_str();
  sql->add_option("--draws", options->choice.draws, "a multiple of 20; more are finer")
      ->capture_default_str();
  sql->add_option("--part", options->part, "one of the two statements alone")
      ->check(one_of({"all", "setup", "query"}))
      ->capture_default_str();
  sql->footer(
      "A unit that the study has seen has draws given its readings; any other those of a new "
      "one.\n\nExample:\n  wearwell export sql study-results --dialect postgresql --table "
      "fleet.liners --columns force=F:kN > wear.sql\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong.");
  sql->callback([options, &exit_code] { exit_code = run_export_sql(*options); });
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("export", "Write a fitted law as C or SQL");
  command->require_subcommand(1);
  CLI::App* c = command->add_subcommand(
      "c",
      "As C99 without allocation: readings in, wear and remaining useful life with quantiles out");
  const auto options = std::make_shared<ExportOptions>();
  c->add_option("RESULT", options->result,
                "folder that wearwell fit wrote of a model \"formula\" with a limit")
      ->required();
  c->add_option("-o,--output", options->output, "folder for header, source and test")->required();
  c->add_option("--name", options->choice.name, "begins the names of files and functions")
      ->capture_default_str();
  c->add_option("--unit", options->choice.unit,
                "a unit of the study, about what it has shown (default: a new one)");
  c->add_option("--lines", options->choice.lines,
                "points of the posterior: more are finer and larger (default: as on line)")
      ->check(CLI::Range(16, 20000));
  c->footer(
      "The law's families may be normal and lognormal; paths of random steps, sums over rows and "
      "states by "
      "their\nrate are refused.\n\nExample:\n  wearwell export c study-results -o pump --name "
      "pump\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong, nothing written.");
  add_sql(*command, exit_code);
  c->callback([options, &exit_code] { exit_code = run_export(*options); });
}

}  // namespace wearwell::formula_model
