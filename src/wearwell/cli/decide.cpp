#include "wearwell/cli/decide.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/printable.h"
#include "wearwell/cli/lives_input.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/present/page.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/prognosis/decision_request.h"

namespace wearwell {
namespace prognosis {
namespace {

struct DecideOptions {
  LivesOptions lives;
  DecisionRequest request;
  std::filesystem::path output;
  double service = 95;
  bool json = false;
};

int run_decide(const DecideOptions& options, Models models) {
  LivesInput read = read_lives(options.lives, models);
  DecisionRequest request = options.request;
  request.service = options.service / 100;
  const DecisionsReport report = decide(request, std::move(read.lives), read.followed());
  std::optional<ResultFolder> folder;
  if (!options.output.empty()) folder.emplace(options.output);
  if (folder) {
    const std::vector<present::Section> sections = decisions_sections(report);
    folder->write("decisions.json", printable_json(decisions_json(report).dump(2)) + "\n");
    for (const present::Table* table : present::tables(sections))
      folder->write(fmt::format("tables/{}.csv", table->id), present::csv(*table));
    folder->write("report.html",
                  html_page({WEARWELL_VERSION, "Decisions", report.lives.title, sections}));
    folder->commit();
  }
  if (options.json) {
    fmt::print("{}\n", printable_json(decisions_json(report).dump(2)));
  } else {
    fmt::print("{}", decisions_text(report));
    if (folder) fmt::print("Results are in {}\n", options.output.string());
  }
  return report.lives.trusted ? 0 : 1;
}

}  // namespace
}  // namespace prognosis

void add_decide_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<prognosis::DecideOptions>();
  CLI::App* command = app.add_subcommand(
      "decide", "Find the cheapest replacement age, inspection interval and stock of spare parts");
  command
      ->add_option("LIVES", options->lives.path,
                   "Folder that wearwell fit wrote for lives, for a formula model or bearings with "
                   "a failure threshold, or for S-N parts; configuration of a monitor (.toml) for "
                   "the units of its store; or a table of lives with column 'life [h]' and "
                   "optionally weight, unit, population")
      ->required();
  add_lives_options(*command, options->lives);
  command
      ->add_option("--failure-cost", options->request.failure_cost,
                   "Cost of a failure in service, including the replacement: '12000 EUR'")
      ->required();
  command
      ->add_option("--replacement-cost", options->request.replacement_cost,
                   "Cost of a preventive replacement: '900 EUR'")
      ->required();
  command->add_option("--inspection-cost", options->request.inspection_cost,
                      "Cost of one inspection; adds the optimal inspection interval");
  command->add_option("--downtime-cost", options->request.downtime_cost,
                      "Cost of an undetected failure per use until the next inspection: '5 EUR/h'");
  command->add_option("--unit", options->request.unit,
                      "One unit of a result: adds the value of another reading of it");
  command->add_option("--inspect-after", options->request.inspect_after,
                      "Use from now until that reading is taken: '5 km'; '0 km' for now");
  command->add_option(
      "--given", options->request.given,
      "Conditions of that reading: 'force = 20 N', for each column that a reading needs");
  command->add_option(
      "--month", options->request.month,
      "Use of a unit per month, '600 h': adds the failures and spare parts per month");
  command->add_option("--claims", options->request.claims,
                      "Share of units that may fail under warranty, '2 %': adds its length");
  command->add_option("--months", options->request.months, "Number of months ahead")
      ->check(number_between(1, 600))
      ->capture_default_str();
  command
      ->add_option("--service-level", options->service,
                   "Probability that the spare parts suffice, %")
      ->check(number_between(1, 99.9999))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder for the page, tables and JSON");
  command->add_flag("--json", options->json, "Print one JSON object and nothing else");
  command->footer(
      "Examples:\n"
      "  wearwell decide lives.csv --failure-cost '12000 EUR' --replacement-cost '900 EUR'\n"
      "  wearwell decide lives.csv --failure-cost 12 --replacement-cost 1 --inspection-cost 0.1 "
      "--month '600 h'\n"
      "  wearwell decide life-results --failure-cost '800 EUR' --replacement-cost '120 EUR' \\\n"
      "    --claims '2 %' --in-service ages.csv --month '600 h'\n"
      "  wearwell decide fleet.toml --failure-cost 12 --replacement-cost 1 --month '600 h'\n"
      "  wearwell decide study-results --failure-cost 12 --replacement-cost 1 --inspection-cost "
      "0.1 \\\n"
      "    --unit 7 --inspect-after '5 km' --given 'force = 20 N'\n\n"
      "Exit codes: 0 done; 1 the study is not trusted; 2 the request is wrong, nothing written.");
  command->callback(
      [options, models, &exit_code] { exit_code = prognosis::run_decide(*options, models); });
}

}  // namespace wearwell
