#include "wearwell/cli/backtest.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "wearwell/base/printable.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/cli/followed_result.h"
#include "wearwell/prognosis/backtest_report.h"

namespace wearwell {
namespace prognosis {
namespace {

struct BacktestOptions {
  std::filesystem::path result, readings, lives, output;
  bool json = false;
};

int run_backtest(const BacktestOptions& options, Models models) {
  const FollowedResult result = followed_result(options.result, models);
  const Tracker& tracker = *result.tracker;
  const Backtest test = backtest(tracker, read_table(options.readings), read_table(options.lives));
  if (!options.output.empty()) write_file(options.output, backtest_csv(test, tracker));
  if (options.json) {
    fmt::print("{}\n", printable_json(backtest_json(test).dump(2)));
  } else {
    fmt::print("{}", backtest_text(test, tracker));
    if (!options.output.empty()) fmt::print("Each forecast is in {}\n", options.output.string());
  }
  return result.trusted ? 0 : 1;
}

}  // namespace
}  // namespace prognosis

void add_backtest_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<prognosis::BacktestOptions>();
  CLI::App* command = app.add_subcommand(
      "backtest", "Check forecasts of remaining useful life against units whose end is known");
  command
      ->add_option("RESULT", options->result,
                   "Folder that wearwell fit wrote for a formula model, bearings or a joint with a "
                   "failure threshold, or for S-N parts")
      ->required();
  command
      ->add_option("READINGS", options->readings,
                   "Table of readings in the order of arrival: the study's columns with their "
                   "units, \"wear [um]\", and the unit's label")
      ->required();
  command
      ->add_option("LIVES", options->lives,
                   "Table of observed ends: the unit's label and \"life [h]\"; empty for units "
                   "that still run")
      ->required();
  command->add_option("-o,--output", options->output, "File for each forecast, FILE.csv");
  command->add_flag("--json", options->json, "Print one JSON object and nothing else");
  command->footer(
      "Example:\n  wearwell backtest study-results readings.jsonl truth.csv\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong, nothing written.");
  command->callback(
      [options, models, &exit_code] { exit_code = prognosis::run_backtest(*options, models); });
}

}  // namespace wearwell
