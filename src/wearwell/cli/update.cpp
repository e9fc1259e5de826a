#include "wearwell/cli/update.h"

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

#include "wearwell/base/error.h"
#include "wearwell/base/same_file.h"
#include "wearwell/cli/carried.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/present/progress_line.h"
#include "wearwell/prognosis/update.h"
#include "wearwell/study/result_writer.h"

namespace wearwell {
namespace {

struct UpdateOptions {
  std::filesystem::path result, output;
  std::vector<std::filesystem::path> data;
  std::string repeated;
  int threads = 0;
  bool json = false, quiet = false, no_report = false;
};

Result run_shown(const Study& study, const RunOptions& run, const UpdateOptions& options) {
  ProgressLine line(!options.quiet && isatty(STDERR_FILENO) ? stderr : nullptr);
  const Monitor monitor{.progress = [&](const Step& step) { line.show(step); },
                        .threads = options.threads};
  return study.run(run, monitor);
}

void write_updated(const UpdateOptions& options, const Result& result, const std::string& text,
                   ResultFolder& folder) {
  write_result(result, text, folder);
  if (options.json) {
    fmt::print("{}", summary_text(result));
  } else if (!options.quiet) {
    fmt::print("{}Results are in {}\n", terminal_text(result, terminal_style()),
               folder.path().string());
  }
}

int run_update(const UpdateOptions& options, Models models) {
  std::vector<NamedFile> inputs;
  for (const auto& file : options.data) inputs.push_back({"the new data", file});
  refuse_overwriting(inputs, {{"--output", options.output}});
  const prognosis::CarriedState state = read_carried_data(options.result);
  prognosis::StudyOfAllRows all = prognosis::study_of_all_rows(
      state, {options.data.begin(), options.data.end()},
      prognosis::repeated_named(options.repeated),
      [&](const Source& source) { return read_study(source, models); });
  ResultFolder folder(options.output);
  Result result = run_shown(*all.study, {sampler_of(options.result), !options.no_report}, options);
  const std::string text = all.source.study.text;
  std::string bytes = prognosis::state_of_all_rows(std::move(all.source), result);
  if (!bytes.empty()) result.files.emplace_back("state.bin", std::move(bytes));
  write_updated(options, result, text, folder);
  return result.header.trusted ? 0 : 1;
}

}  // namespace

void add_update_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<UpdateOptions>();
  CLI::App* update = app.add_subcommand("update", "Refit a result together with new data");
  update->add_option("RESULT", options->result, "Folder that fit or update wrote, or its state.bin")
      ->required();
  update
      ->add_option("NEW-DATA", options->data,
                   "Tables with the headings of the study's data; units may differ")
      ->required();
  update->add_option("-o,--output", options->output, "Folder for the results")->required();
  update
      ->add_option("--repeated", options->repeated,
                   "Meaning of a test that equals an earlier one: the same test again, or another")
      ->check(one_of({"once", "another"}))
      ->type_name("WHAT");
  update
      ->add_option("--threads", options->threads,
                   "Threads (default: all); results do not depend on the number")
      ->check(CLI::Range(1, 1024));
  CLI::Option* json =
      update->add_flag("--json", options->json, "Print summary.json and nothing else");
  update->add_flag("--quiet", options->quiet, "Print nothing but errors")->excludes(json);
  update->add_flag("--no-report", options->no_report, "Write no report.html");
  update->footer(
      "Examples:\n"
      "  wearwell update study-results june.csv -o june\n"
      "  wearwell update june july.csv august.csv -o august --json | jq .update\n\n"
      "A repeated reading counts once; order does not matter; a reading that contradicts the "
      "posterior is counted,\n"
      "and reported by the check new-data. Method, chains, draws and seed are those of RESULT.\n\n"
      "Exit codes: as for fit.");
  update->callback([options, models, &exit_code] { exit_code = run_update(*options, models); });
}

}  // namespace wearwell
