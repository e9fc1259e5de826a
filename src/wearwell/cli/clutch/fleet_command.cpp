#include "wearwell/cli/clutch/fleet_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/fleet_columns.h"
#include "wearwell/models/clutch/fleet_run.h"

namespace wearwell::clutch {
namespace {

// Horizons of cycles are numbers.
std::vector<double> cycles_ahead(const std::vector<std::string>& texts) {
  std::vector<double> horizons;
  const CLI::Validator in_range = number_between(0, 1e15);
  for (const std::string& each : texts) {
    const std::string problem = in_range(each);
    if (!problem.empty())
      throw InputError(fmt::format("--horizon: {} (cycles of a clutch, a number)", problem));
    horizons.push_back(std::stod(each));
  }
  return horizons;
}

}  // namespace

int run_clutch_fleet(const FleetOptions& options) {
  for (const char* each : {"--at", "--in-study"})
    if (options.has(each))
      throw InputError(fmt::format("{}: is for studies of lives; this result is a clutch", each));
  const std::vector<double> horizons = cycles_ahead(options.horizons);
  const IdentifiedModel model = read_identified_model(options.result);
  ResultFolder folder(options.output);
  const bool first = options.engines.front() == "duckdb" &&
                     (options.state.empty() || !std::filesystem::exists(options.state));
  const auto engines =
      engines_of(options, unit_column(options.columns), folder.path().parent_path());
  std::vector<fleet::Engine*> all;
  for (const auto& each : engines) all.push_back(each.get());
  return show_fleet(options, folder, [&](const Monitor& monitor) {
    return find_fleet(model, all,
                      {.columns = options.columns,
                       .files = options.files,
                       .prefix = options.prefix,
                       .first = first,
                       .read_only = options.read_only,
                       .skip_bad = options.skip_bad,
                       .replicates = !options.scatter_only,
                       .statements = options.statements,
                       .levels = options.levels,
                       .horizons = horizons,
                       .days = options.days},
                      monitor);
  });
}

}  // namespace wearwell::clutch
