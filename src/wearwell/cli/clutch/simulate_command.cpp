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

// Of an earlier campaign they are replaced; whatever else is in the folder stays.
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
  fmt::print("{}: a simulated campaign of {} plates, {} cycles, {} weighings\n",
             options.output.string(), simulation.plate_factors.size(), campaign.cycles.size(),
             campaign.weighings.size());
}

}  // namespace

void add_simulate_command(CLI::App& clutch) {
  CLI::App* command = clutch.add_subcommand(
      "simulate", "Run a campaign on a simulated rig whose truth is known, into files as of a rig");
  const auto options = std::make_shared<SimulateOptions>();
  command->add_option("--design", options->design, "operating points (CSV), of clutch design")
      ->required();
  command->add_option("--truth", options->truth, "what is true (TOML)")->required();
  command->add_option("--seed", options->seed, "seed of the campaign")
      ->check(seed_number())
      ->capture_default_str();
  command->add_option("--traces", options->traces, "closings to write raw traces of")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "folder for the files")->required();
  command->footer(
      "Writes cycles.csv, weighings.csv, traces.csv, and what no rig knows, realized.csv: the true "
      "volumes.\n\nExample:\n  wearwell clutch simulate --design design.csv --truth truth.toml "
      "--seed 2 -o campaign");
  command->callback([options] { run(*options); });
}

}  // namespace wearwell::clutch
