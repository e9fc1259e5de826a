#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/same_file.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/cli/clutch/command_parts.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/clutch/closing.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell::clutch {
namespace {

struct FeatureOptions {
  std::filesystem::path traces, output;
  std::string torque_on = "2 N m", slip_off = "0.5 rad/s";
};

int run(const FeatureOptions& options) {
  refuse_overwriting({{"the traces", options.traces}}, {{"--output", options.output}});
  ClosingRule rule;
  rule.torque_on = option_value("--torque-on", options.torque_on, "N m", Allowed::not_negative);
  rule.slip_off = option_value("--slip-off", options.slip_off, "rad/s", Allowed::not_negative);
  const std::vector<Sample> samples = read_traces(options.traces);
  std::vector<Closing> closings;
  try {
    closings = find_closings(samples, rule);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}, {}", options.traces.string(), error.what()));
  }
  if (closings.empty())
    throw InputError(fmt::format("{} has no closing: torque never exceeds {}",
                                 options.traces.string(), options.torque_on));
  const std::string csv = closings_csv(closings);
  if (options.output.empty()) {
    fmt::print("{}", csv);
  } else {
    write_file(options.output, csv);
  }
  int flagged = 0;
  for (const Closing& closing : closings) {
    if (closing.flag.empty()) continue;
    ++flagged;
    fmt::print(stderr, "plate {}, closing {} at {:.6g} s: {}\n", closing.cycle.plate,
               closing.cycle.number, closing.start, closing.flag);
  }
  return flagged > 0 ? 1 : 0;
}

}  // namespace

void add_features_command(CLI::App& clutch, int& exit_code) {
  CLI::App* command = clutch.add_subcommand(
      "features", "Find the closings in raw traces: slip speed, torque, temperature, time, energy");
  const auto options = std::make_shared<FeatureOptions>();
  command->add_option("TRACES", options->traces, "plate, time, slip_speed, torque, temperature")
      ->required();
  command->add_option("--torque-on", options->torque_on, "Torque above which the clutch closes")
      ->capture_default_str();
  command
      ->add_option("--slip-off", options->slip_off, "Slip speed below which the clutch is closed")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "File (default: standard output)");
  command->footer(
      "A closing with a gap, one that never closes, or a torque of the wrong sign is written with "
      "a flag and\n"
      "named on standard error; the exit code is then 1.\n\n"
      "Example:\n"
      "  wearwell clutch features traces.csv -o cycles.csv");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace wearwell::clutch
