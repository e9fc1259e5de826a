#include "wearwell/cli/formula/export_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "wearwell/base/printable.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/formula_model/export_files.h"
#include "wearwell/present/result_folder.h"

namespace wearwell::formula_model {
namespace {

struct ExportOptions {
  std::filesystem::path result, output;
  CExportChoice choice;
};

int run_export(const ExportOptions& options) {
  const prognosis::CarriedState state = prognosis::read_state(options.result);
  require_formula_state(state, options.result.string(), "C");
  const CExport made = c_export(state, options.choice, WEARWELL_VERSION);
  const std::string& name = options.choice.name;
  ResultFolder folder(options.output);
  for (const auto& [file, content] : c_files(made, name)) folder.write(file, content);
  folder.commit();
  fmt::print("{}", c_sizes(made));
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
  require_formula_state(state, options.result.string(), "SQL");
  options.choice.dialect = fleet::read_dialect(options.dialect);
  const SqlExport made = sql_export(state, options.choice);
  fmt::print("{}", sql_script(made, options.choice, options.part, WEARWELL_VERSION));
  return state.trusted ? 0 : 1;
}

void add_sql(CLI::App& command, int& exit_code) {
  CLI::App* sql = command.add_subcommand(
      "sql",
      "Print SQL that computes a value of the formula with its interval for every row of a table");
  const auto options = std::make_shared<SqlOptions>();
  sql->add_option("RESULT", options->result,
                  "Folder that wearwell fit wrote for a model \"formula\"")
      ->required();
  sql->add_option("--dialect", options->dialect, "SQL dialect of the database")
      ->required()
      ->check(one_of(fleet::dialect_names()));
  sql->add_option("--table", options->choice.table,
                  "SCHEMA.TABLE; a part in double quotes may hold dots")
      ->required();
  sql->add_option("--value", options->choice.value,
                  "An expression of the formula (default: the expression that the first measured "
                  "column observes)");
  sql->add_option("--unit", options->choice.unit, "Unit of the answer");
  sql->add_option("--columns", options->choice.columns,
                  "Columns of the table that have other names or units than in the study's file: "
                  "NAME=COLUMN:UNIT")
      ->type_name("NAME=COLUMN:UNIT");
  sql->add_option("--keep", options->choice.keep,
                  "Further columns of the table to include in the answer")
      ->delimiter(',');
  sql->add_option("--prefix", options->choice.prefix,
                  "Name of the table of draws that the statements create")
      ->capture_default_str();
  sql->add_option("--draws", options->choice.draws,
                  "Number of draws, a multiple of 20; more draws give more precise intervals")
      ->capture_default_str();
  sql->add_option("--part", options->part, "Print only one of the two statements")
      ->check(one_of({"all", "setup", "query"}))
      ->capture_default_str();
  sql->footer(
      "Draws of a unit in the study are conditioned on its readings; any other unit gets draws of "
      "a new unit.\n\n"
      "Example:\n"
      "  wearwell export sql study-results --dialect postgresql --table fleet.liners --columns "
      "force=F:kN > wear.sql\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong.");
  sql->callback([options, &exit_code] { exit_code = run_export_sql(*options); });
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("export", "Write a fitted formula model as C or SQL");
  command->require_subcommand(1);
  CLI::App* c = command->add_subcommand("c",
                                        "C99 without allocation: takes readings, returns wear and "
                                        "remaining useful life with quantiles");
  const auto options = std::make_shared<ExportOptions>();
  c->add_option("RESULT", options->result,
                "Folder that wearwell fit wrote for a model \"formula\" with a failure threshold")
      ->required();
  c->add_option("-o,--output", options->output, "Folder for header, source and test")->required();
  c->add_option("--name", options->choice.name, "Prefix of the names of files and functions")
      ->capture_default_str();
  c->add_option("--unit", options->choice.unit,
                "A unit of the study, conditioned on its readings (default: a new unit)");
  c->add_option("--lines", options->choice.lines,
                "Points of the posterior: more points are more precise and need more memory "
                "(default: as in the monitor)")
      ->check(CLI::Range(16, 20000));
  c->footer(
      "Distributions must be normal or lognormal. Formulas with random increments, sums over rows "
      "or states given\n"
      "by their rate are refused.\n\n"
      "Example:\n"
      "  wearwell export c study-results -o pump --name pump\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong, nothing written.");
  add_sql(*command, exit_code);
  c->callback([options, &exit_code] { exit_code = run_export(*options); });
}

}  // namespace wearwell::formula_model
