#include "wearwell/models/ownlaw/export_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/models/ownlaw/c_export.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/present/text_table.h"

namespace wearwell::ownlaw {
namespace {

struct ExportOptions {
  std::filesystem::path result, output;
  CExportChoice choice;
};

int run_export(const ExportOptions& options) {
  const prognosis::CarriedState state = prognosis::read_state(options.result);
  if (state.model != "law")
    throw InputError(fmt::format("{}: a study of model \"{}\" is not exported to C; \"law\" is",
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

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("export", "Write a unit on line as source of another language");
  command->require_subcommand(1);
  CLI::App* c = command->add_subcommand(
      "c", "As C99 without allocation: readings in, wear and remaining life with quantiles out");
  const auto options = std::make_shared<ExportOptions>();
  c->add_option("RESULT", options->result,
                "folder that wearwell fit wrote of a model \"law\" with a limit")
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
  c->callback([options, &exit_code] { exit_code = run_export(*options); });
}

}  // namespace wearwell::ownlaw
