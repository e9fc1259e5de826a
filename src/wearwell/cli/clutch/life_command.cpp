#include "wearwell/models/clutch/life.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/clutch/command_parts.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"

namespace wearwell::clutch {
namespace {

struct LifeOptions {
  std::filesystem::path model, duty;
  std::string slip_speed, torque, temperature, closing_time;
  std::vector<double> levels = {10, 25, 50, 75, 100};
  bool json = false;
};

double required(const char* flag, const std::string& text, const char* si) {
  if (text.empty()) throw InputError(fmt::format("{} is missing; or give --duty FILE", flag));
  return option_value(flag, text, si);
}

std::vector<Cycle> read_duty(const LifeOptions& options) {
  if (!options.duty.empty()) return read_cycles(options.duty);
  Cycle cycle;
  cycle.at = {required("--slip-speed", options.slip_speed, "rad/s"),
              required("--torque", options.torque, "N m"),
              required("--temperature", options.temperature, "K") - celsius_zero,
              required("--closing-time", options.closing_time, "s")};
  for (const Input& input : inputs) {
    if (input.value != &OperatingPoint::temperature && !(cycle.at.*input.value > 0))
      throw InputError(fmt::format("{} must be positive", input.name));
  }
  cycle.energy = closing_energy(cycle.at);
  return {cycle};
}

void run(const LifeOptions& options) {
  const WearModel model = read_model(options.model);
  std::vector<double> levels;
  for (const double percent : options.levels) levels.push_back(percent / 100);
  const Life life = predict_life(model, read_duty(options), levels);
  if (options.json) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const LifeAtLevel& at : life.levels)
      rows.push_back({{"level", at.level},
                      {"repetitions", at.repetitions},
                      {"without_run_in", at.without_run_in},
                      {"interval_scatter", {at.scatter.low, at.scatter.high}},
                      {"interval_full", {at.full.low, at.full.high}},
                      {"sd_scatter", at.sd / mm3},
                      {"sd_full", at.full_sd / mm3},
                      {"relative_scatter", at.relative},
                      {"relative_full", at.full_relative}});
    const nlohmann::ordered_json json = {{"energy", life.energy},
                                         {"volume", life.volume / mm3},
                                         {"outside", names_of_inputs(life.outside)},
                                         {"levels", std::move(rows)}};
    fmt::print("{}\n", printable_json(json.dump(2)));
    return;
  }
  fmt::print(
      "One repetition takes {} kJ and wears {} mm^3 after run-in; the worn-out volume is {} "
      "mm^3.\n",
      plain_number(life.energy * 1e-3), plain_number(life.volume / mm3),
      plain_given(model.worn_out / mm3));
  if (life.outside)
    fmt::print("Outside the calibrated range: {}.\n", names_of_inputs(life.outside));
  std::vector<std::vector<std::string>> rows = {
      {"worn [%]", "repetitions", "95 % scatter", "95 % full", "without run-in"}};
  for (const LifeAtLevel& at : life.levels)
    rows.push_back({plain_given(100 * at.level), plain_given(std::round(at.repetitions)),
                    description(at.scatter), description(at.full),
                    plain_given(std::round(at.without_run_in))});
  fmt::print("{}", text_table(rows));
  rows = {{"worn [%]", "volume [mm^3]", "95 % scatter", "share", "95 % full", "share"}};
  for (const LifeAtLevel& at : life.levels)
    rows.push_back({plain_given(100 * at.level), plain_given(at.level * model.worn_out / mm3),
                    "+- " + plain_number(2 * at.sd / mm3),
                    fmt::format("{:.1f} %", 100 * at.relative),
                    "+- " + plain_number(2 * at.full_sd / mm3),
                    fmt::format("{:.1f} %", 100 * at.full_relative)});
  fmt::print(
      "Volume after this number of cycles:\n"
      "{}",
      text_table(rows));
}

}  // namespace

void add_life_command(CLI::App& clutch) {
  CLI::App* command = clutch.add_subcommand(
      "life", "Cycles to any wear level for an operating point or a repeated duty");
  const auto options = std::make_shared<LifeOptions>();
  command
      ->add_option("MODEL", options->model,
                   "model.json of wearwell fit, or the folder that holds it")
      ->required();
  command->add_option("--slip-speed", options->slip_speed)->type_name("'NUMBER rpm'");
  command->add_option("--torque", options->torque)->type_name("'NUMBER N m'");
  command->add_option("--temperature", options->temperature)->type_name("'NUMBER degC'");
  command->add_option("--closing-time", options->closing_time)->type_name("'NUMBER s'");
  command->add_option("--duty", options->duty, "Cycles of one repetition (format as for predict)");
  command->add_option("--level", options->levels, "Wear levels in % of the worn-out volume")
      ->delimiter(',')
      ->check(number_between(1e-6, 1e6))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Example:\n  wearwell clutch life study-results/model.json --slip-speed '1700 rpm' --torque "
      "'50 N m' \\\n    --temperature '170 degC' --closing-time '2.15 s'");
  command->callback([options] { run(*options); });
}

}  // namespace wearwell::clutch
