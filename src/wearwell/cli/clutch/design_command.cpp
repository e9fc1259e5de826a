#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/base/unit.h"
#include "wearwell/cli/clutch/command_parts.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/design.h"

namespace wearwell::clutch {
namespace {

struct DesignOptions {
  std::array<std::string, 4> levels = {"1200, 1700, 2800 rpm", "25, 50, 75 N m",
                                       "120, 170, 240 degC", "0.9, 2.15, 3.4 s"};
  std::array<std::string, 4> feasible;
  std::string most_energy;
  int inside = 20, outside = 20;
  std::uint64_t seed = 1;
  std::filesystem::path output;
};

constexpr std::array<const char*, 4> flags = {"--slip-speed", "--torque", "--temperature",
                                              "--closing-time"};
// Points between the levels are rounded to this, in the unit of the levels.
constexpr std::array<double, 4> steps = {1, 0.1, 0.1, 0.01};
/// Default margin of feasible ranges beyond the levels, as a fraction of the levels' range.
constexpr double default_reach = 0.1;

struct Values {
  std::vector<double> values;  ///< as in OperatingPoint
  double unit = 1;             ///< size of the given unit
};

/// "1200, 1700, 2800 rpm": numbers followed by one unit; "1000 .. 3000 rpm" likewise.
Values read_values(const std::string& flag, std::string text, const Input& input) {
  const auto fail = [&](const std::string& reason) {
    throw InputError(fmt::format("{}: '{}': {}", flag, text, reason));
  };
  std::size_t unit_at = text.find_first_not_of("0123456789+-.eE, \t");
  if (unit_at != std::string::npos && unit_at > 1 && text.compare(unit_at - 2, 3, " 1/") == 0)
    --unit_at;  // of 1/min
  if (unit_at == std::string::npos) fail("the unit is missing");
  Unit unit;
  try {
    unit = read_unit(text.substr(unit_at), input.si);
  } catch (const InputError& error) {
    fail(error.what());
  }
  Values result{{}, unit.scale};
  std::string numbers = text.substr(0, unit_at);
  for (std::size_t at; (at = numbers.find("..")) != std::string::npos;) numbers.replace(at, 2, ",");
  for (std::size_t from = 0; from <= numbers.size();) {
    const std::size_t end = std::min(numbers.find(',', from), numbers.size());
    double x = 0;
    try {
      x = read_quantity(numbers.substr(from, end - from), "1").value;
    } catch (const InputError&) {
      fail("write numbers separated by commas and followed by one unit: '1200, 1700, 2800 rpm'");
    }
    const double offset = input.value == &OperatingPoint::temperature ? celsius_zero : 0;
    result.values.push_back(checked_option(flag, text, to_si(unit, x) - offset, Allowed::any));
    from = end + 1;
  }
  return result;
}

DesignRequest read_request(const DesignOptions& options) {
  DesignRequest request;
  request.inside = options.inside;
  request.outside = options.outside;
  request.seed = options.seed;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Values levels = read_values(flags[i], options.levels[i], inputs[i]);
    request.levels[i] = levels.values;
    request.step[i] = steps[i] * levels.unit;
    const double reach = default_reach * (levels.values.back() - levels.values.front());
    request.lowest[i] = levels.values.front() - reach;
    request.highest[i] = levels.values.back() + reach;
    if (options.feasible[i].empty()) continue;
    const std::string flag = fmt::format("--feasible-{}", flags[i] + 2);
    const Values range = read_values(flag, options.feasible[i], inputs[i]);
    if (range.values.size() != 2)
      throw InputError(fmt::format("{}: write a range as 'LOW .. HIGH UNIT'", flag));
    request.lowest[i] = range.values[0];
    request.highest[i] = range.values[1];
  }
  if (!options.most_energy.empty()) {
    request.most_energy =
        option_value("--most-energy", options.most_energy, "J", Allowed::positive);
  }
  return request;
}

void run(const DesignOptions& options) {
  const std::string csv = design_csv(plan(read_request(options)));
  if (options.output.empty()) {
    fmt::print("{}", csv);
  } else {
    write_file(options.output, csv);
  }
}

}  // namespace

void add_design_command(CLI::App& clutch) {
  CLI::App* command = clutch.add_subcommand("design",
                                            "Plan a rig campaign: full factorial, points outside "
                                            "it, and points inside it for validation");
  const auto options = std::make_shared<DesignOptions>();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    command->add_option(flags[i], options->levels[i], "Levels, followed by one unit")
        ->type_name("LEVELS")
        ->capture_default_str();
    command
        ->add_option(fmt::format("--feasible-{}", flags[i] + 2), options->feasible[i],
                     "Range of the points outside (default: a tenth beyond the levels' range)")
        ->type_name("'LOW .. HIGH UNIT'");
  }
  command->add_option("--most-energy", options->most_energy, "Feasible energy of one closing")
      ->type_name("'NUMBER kJ'");
  command->add_option("--inside", options->inside, "Number of validation points")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--outside", options->outside, "Number of points beyond the levels")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the candidates")
      ->check(seed_number())
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "File (default: standard output)");
  command->footer(
      "Example:\n  wearwell clutch design --torque '25, 50, 75 N m' --feasible-torque '20 .. 85 N "
      "m' "
      "-o design.csv");
  command->callback([options] { run(*options); });
}

}  // namespace wearwell::clutch
