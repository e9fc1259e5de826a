#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "wearwell/base/same_file.h"
#include "wearwell/base/staged_folder.h"
#include "wearwell/cli/clutch/command_parts.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/clutch_truth.h"

namespace wearwell::clutch {
namespace {

struct SimulateOptions {
  std::filesystem::path design, truth, output;
  std::uint64_t seed = 1;
  int traces = 5;
};

// Files of an earlier campaign are replaced; other files in the folder stay.
const std::vector<std::string> campaign_files = {"cycles.csv", "weighings.csv", "traces.csv",
                                                 "realized.csv"};

void run(const SimulateOptions& options) {
  for (const std::string& name : campaign_files)
    refuse_overwriting({{"--design", options.design}, {"--truth", options.truth}},
                       {{"--output", options.output / name}});
  const Simulation simulation =
      simulate(read_design(options.design), read_truth(options.truth), options.seed);
  const Campaign& campaign = simulation.campaign;
  StagedFolder folder(options.output, campaign_files);
  folder.write("cycles.csv", cycles_csv(campaign.cycles));
  folder.write("weighings.csv", weighings_csv(campaign.weighings));
  folder.write("traces.csv", traces_csv(simulate_traces(campaign, options.traces, options.seed)));
  folder.write("realized.csv", realized_csv(simulation.realized));
  folder.commit(campaign_files);
  fmt::print("{}: simulated campaign of {} plates, {} cycles, {} weighings\n",
             options.output.string(), simulation.plate_factors.size(), campaign.cycles.size(),
             campaign.weighings.size());
}

}  // namespace

void add_simulate_command(CLI::App& clutch) {
  CLI::App* command = clutch.add_subcommand(
      "simulate",
      "Simulate a campaign with known truth and write its files in the format of a real rig");
  const auto options = std::make_shared<SimulateOptions>();
  command
      ->add_option("--design", options->design,
                   "Operating points (CSV), as wearwell clutch design writes them")
      ->required();
  command->add_option("--truth", options->truth, "The true parameters (TOML)")->required();
  command->add_option("--seed", options->seed, "Seed of the campaign")
      ->check(seed_number())
      ->capture_default_str();
  command->add_option("--traces", options->traces, "Closings whose raw traces are written")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "Folder for the files")->required();
  command->footer(
      "Writes cycles.csv, weighings.csv, traces.csv, and realized.csv with the true volumes, which "
      "a real rig cannot know.\n\n"
      "Example:\n"
      "  wearwell clutch simulate --design design.csv --truth truth.toml --seed 2 -o campaign");
  command->callback([options] { run(*options); });
}

}  // namespace wearwell::clutch
