#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/lock_file.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/base/unit.h"
#include "wearwell/cli/fatigue/command_parts.h"
#include "wearwell/cli/fatigue/counting_options.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/fatigue/history_request.h"
#include "wearwell/models/fatigue/history_state.h"
#include "wearwell/models/fatigue/signal_file.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"

namespace wearwell::fatigue {
namespace {

struct RainflowOptions {
  HistoryRequest request;
  std::filesystem::path state, output;
  bool json = false;
};

// A state continues with the settings of its first run.
LoadHistory begin(const RainflowOptions& options, const SignalFile& file,
                  const CountingRule& rule) {
  std::error_code ignored;
  if (options.state.empty() || !std::filesystem::exists(options.state, ignored))
    return LoadHistory(rule);
  SavedHistory saved = read_history_state(options.state);
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}; continue with the same settings, or use another --state",
                                 options.state.string(), what));
  };
  if (saved.unit != file.unit())
    refuse(fmt::format("the state counts '{}', this signal is in '{}'", saved.unit, file.unit()));
  const CountingRule& before = saved.state.rule;
  if (!(before == rule))
    refuse(fmt::format("the state was counted with --method {} --residual {} --bin-width {}",
                       counting_name(before.counting), residual_name(before.residual),
                       before.class_width));
  return LoadHistory(std::move(saved.state));
}

void write_folder(const HistoryReport& report, ResultFolder& folder) {
  folder.write("rainflow.json", printable_json(history_json(report).dump(2)) + "\n");
  for (const present::Table& table :
       {cycles_table(report), matrix_table(report), spectrum_table(report), levels_table(report)}) {
    folder.write(fmt::format("tables/{}.csv", table.id), present::csv(table));
    folder.write(fmt::format("tables/{}.parquet", table.id), parquet(table));
  }
  folder.write("report.html",
               html_page({WEARWELL_VERSION, fmt::format("Load history {}", report.source),
                          fmt::format("{}, {} samples", report.column, report.counted.samples),
                          history_sections(report)}));
  folder.commit();
}

void run(const RainflowOptions& options) {
  refuse_overwriting({{"the history", options.request.counting.signal.file}},
                     {{"--state", options.state}, {"--output", options.output}});
  const CountingRule rule = options.request.counting.rule(options.request.bin_width);
  std::optional<LockFile> lock;
  const bool kept = !options.state.empty();
  if (kept)
    lock.emplace(options.state, [&] {
      fmt::print(stderr, "waiting for another wearwell that updates {}\n", options.state.string());
    });
  SignalFile file(options.request.counting.signal);
  LoadHistory history = begin(options, file, rule);
  std::optional<StagedFile> state;
  if (kept) state.emplace(options.state);  // refused before the work starts
  std::optional<ResultFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output);
  const HistoryReport report = counted_history(options.request, file, history);
  if (state) state->write(state_text({file.column(), file.unit(), history.state()}));
  if (folder) write_folder(report, *folder);
  if (state) state->commit();
  lock.reset();
  if (options.json) {
    fmt::print("{}\n", printable_json(history_json(report).dump(2)));
  } else {
    fmt::print("{}", history_text(report));
    if (folder) fmt::print("Results are in {}\n", options.output.string());
  }
}

}  // namespace

void add_rainflow_command(CLI::App& fatigue) {
  CLI::App* command = fatigue.add_subcommand(
      "rainflow", "Count the cycles of a load history by ASTM E1049; files may exceed memory");
  const auto options = std::make_shared<RainflowOptions>();
  command
      ->add_option("FILE", options->request.counting.signal.file,
                   "Samples, or peaks and valleys, in a column (CSV, Parquet, ...)")
      ->required();
  add_counting_options(*command, options->request.counting, "");
  command->add_option("--time", options->request.counting.signal.time,
                      "A column of times; refuses a file with missing samples");
  CLI::Option* bins =
      command->add_option("--bins", options->request.bins, "Largest number of range classes shown")
          ->check(CLI::Range(1, 1024))
          ->capture_default_str();
  command
      ->add_option("--bin-width", options->request.bin_width,
                   "Width of these classes, in the unit of the load (default: a power of two)")
      ->check(number_between(1e-300, 1e150))
      ->excludes(bins);
  command->add_option("--state", options->state,
                      "Continue from this state file if it exists, and write the new state to it");
  command->add_option("-o,--output", options->output,
                      "Folder for the page and the tables (CSV and Parquet)");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Ranges are from valley to peak: twice the amplitude.\n\n"
      "Examples:\n"
      "  wearwell fatigue rainflow loads.csv --column stress\n"
      "  wearwell fatigue rainflow loads.parquet --column sg1 --unit MPa --residual repeat -o "
      "loads\n"
      "  wearwell fatigue rainflow monday.csv --state week.json && \\\n"
      "  wearwell fatigue rainflow tuesday.csv --state week.json");
  command->callback([options] { run(*options); });
}

}  // namespace wearwell::fatigue
