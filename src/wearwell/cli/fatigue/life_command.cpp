#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/cli/fatigue/command_parts.h"
#include "wearwell/cli/fatigue/counting_options.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/fatigue/load_life_request.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"

namespace wearwell::fatigue {
namespace {

struct LoadLifeOptions {
  std::filesystem::path result, output;
  LoadLifeRequest request;
  double confidence = 90;
  bool json = false;
};

void write_folder(const LoadLifeReport& report, ResultFolder& folder) {
  const std::vector<present::Section> sections = load_life_sections(report);
  folder.write("life.json", printable_json(load_life_json(report).dump(2)) + "\n");
  for (const present::Table* table : present::tables(sections))
    folder.write(fmt::format("tables/{}.csv", table->id), present::csv(*table));
  folder.write("report.html", html_page({WEARWELL_VERSION, "Life under a load history",
                                         report.result.title, sections}));
  folder.commit();
}

int run(const LoadLifeOptions& options) {
  refuse_overwriting(
      {{"the results", options.result}, {"the history", options.request.counting.signal.file}},
      {{"--output", options.output}});
  SnResult result = read_sn_result(options.result);
  std::optional<ResultFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output);
  LoadLifeRequest request = options.request;
  request.confidence = options.confidence / 100;
  const LoadLifeReport report = load_life_of(request, std::move(result));
  if (folder) write_folder(report, *folder);
  if (options.json) {
    fmt::print("{}\n", printable_json(load_life_json(report).dump(2)));
  } else {
    fmt::print("{}", load_life_text(report));
    if (folder) fmt::print("Results are in {}\n", options.output.string());
  }
  return report.result.trusted ? 0 : 1;
}

}  // namespace

void add_life_command(CLI::App& fatigue, int& exit_code) {
  CLI::App* command = fatigue.add_subcommand(
      "life", "Damage and life under a load history, as distributions, from a fitted S-N study");
  const auto options = std::make_shared<LoadLifeOptions>();
  command
      ->add_option("RESULT", options->result, "Folder that wearwell fit wrote for a model \"sn\"")
      ->required();
  command
      ->add_option("HISTORY", options->request.counting.signal.file,
                   "One block: a signal, or counted cycles (range or amplitude, mean, cycles)")
      ->required();
  add_counting_options(*command, options->request.counting, "for a signal: ");
  command->add_option("--time", options->request.counting.signal.time,
                      "For a signal: a column of times; refuses a file with missing samples and, "
                      "without --block, reports lives in h");
  command->add_option("--scale", options->request.scale,
                      "Factor from the load to stress, like '0.35 MPa/N'; for a strain '206 GPa'");
  command
      ->add_option(
          "--rule", options->request.rule,
          "Damage accumulation rule (default: elementary; original with a random fatigue limit)")
      ->check(one_of(miner_rule_names()));
  command->add_option("--knee", options->request.knee,
                      "Knee of the curve: '2e6 cycles', or a fully reversed amplitude '150 MPa'");
  command
      ->add_option(
          "--damage-sum", options->request.damage_sum,
          "Damage sum at failure: a number, or a median and the factor that covers two thirds")
      ->capture_default_str();
  command->add_option("--block", options->request.block,
                      "Use of one block: '350 km', '8 h'; lives are reported in this unit");
  command->add_option("--b-lives", options->request.b_lives, "Percentages failed")
      ->check(number_between(1e-4, 99.9999))
      ->capture_default_str();
  command->add_option("--confidence", options->confidence, "Confidence of the lower bounds, %")
      ->check(number_between(1, 99.99))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder for the page and the tables");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Rules below the knee: original no damage; haibach slope 2k - 1; liu-zenner slope (k + "
      "3.6)/2 "
      "down to half\nof it; elementary has no knee. A damage sum of '1 x/ 1.34' is Wirsching's: "
      "median 1, 30 % scatter.\n\n"
      "Examples:\n"
      "  wearwell fatigue life study-results loads.csv --column stress --block '350 km'\n"
      "  wearwell fatigue life study-results loads.csv --time 'time [s]'\n"
      "  wearwell fatigue life study-results loads.csv --rule haibach --knee '2e6 cycles'\n"
      "  wearwell fatigue life study-results cycles.csv --damage-sum '0.5 x/ 2' --json\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong, nothing written.");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace wearwell::fatigue
