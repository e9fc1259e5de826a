#include "wearwell/cli/backtest.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/cli/followed_result.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/table.h"
#include "wearwell/present/text_table.h"
#include "wearwell/prognosis/backtest.h"

namespace wearwell {
namespace prognosis {
namespace {

struct BacktestOptions {
  std::filesystem::path result, readings, lives, output;
  bool json = false;
};

std::string reported(const Backtest& test, const Tracker& tracker) {
  std::string text = wrapped(fmt::format(
      "{} readings of {} {}s: {} repeated and counted once, {} refused, {} that contradict earlier "
      "ones",
      test.readings, test.units, tracker.noun(), test.repeated, test.refused, test.contradicting));
  if (test.refused > 0) text += wrapped("first refused: " + printable(test.first_refused), 2, 4);
  if (test.without_life > 0)
    text += fmt::format("{} {}s have no observed end yet and do not count\n", test.without_life,
                        tracker.noun());
  std::vector<std::vector<std::string>> rows = {{"readings so far", tracker.noun() + "s",
                                                 "forecasts", "covered", "coverage [%]",
                                                 "by chance [%]", "width", "error"}};
  for (const HeldAt& each : test.ages)
    rows.push_back({"  " + each.age, fmt::format("{}", each.units),
                    fmt::format("{}", each.forecasts), fmt::format("{}", each.held),
                    fmt::format("{:.1f}", 100. * static_cast<double>(each.held) /
                                              static_cast<double>(each.forecasts)),
                    fmt::format("{:.1f} to {:.1f}", 100 * each.low, 100 * each.high),
                    plain_number(each.width, 2), plain_number(each.error, 2)});
  return text + "\nForecasts of remaining useful life against the observed end\n" +
         text_table(rows) +
         wrapped(
             "Covered: by the 90 % interval. Forecasts of one unit are correlated, so the range by "
             "chance counts units, not "
             "forecasts. Width and error are medians, relative to the true remaining useful life.",
             2, 2);
}

nlohmann::ordered_json as_json(const Backtest& test) {
  nlohmann::ordered_json json = {
      {"readings", test.readings},           {"units", test.units},
      {"repeated", test.repeated},           {"refused", test.refused},
      {"contradicting", test.contradicting}, {"without_life", test.without_life}};
  auto ages = nlohmann::ordered_json::array();
  for (const HeldAt& each : test.ages)
    ages.push_back({{"readings", each.age},
                    {"units", each.units},
                    {"forecasts", each.forecasts},
                    {"held", each.held},
                    {"low", each.low},
                    {"high", each.high},
                    {"width", each.width},
                    {"error", each.error}});
  json["ages"] = std::move(ages);
  return json;
}

std::string as_csv(const Backtest& test, const Tracker& tracker) {
  const Unit& unit = tracker.axis().unit;
  present::Table table{"forecasts",
                       "Forecasts",
                       {{tracker.noun()},
                        {"readings"},
                        {tracker.axis().name, unit.text},
                        {"life", unit.text},
                        {"q05", unit.text},
                        {"q50", unit.text},
                        {"q95", unit.text},
                        {"place"}}};
  for (const Hindcast& each : test.hindcasts)
    table.rows.push_back({each.unit, present::count(each.readings), from_si(unit, each.at),
                          from_si(unit, each.life), from_si(unit, each.q05),
                          from_si(unit, each.q50), from_si(unit, each.q95), each.place});
  return present::csv(table);
}

int run_backtest(const BacktestOptions& options, Models models) {
  const FollowedResult result = followed_result(options.result, models);
  const Tracker& tracker = *result.tracker;
  const auto lives = lives_by_unit(tracker, read_table(options.lives));
  const Backtest test = backtest(tracker, read_table(options.readings), lives);
  if (test.hindcasts.empty())
    throw InputError(fmt::format("{}: no unit of {} has a known end there", options.lives.string(),
                                 options.readings.string()));
  if (!options.output.empty()) write_file(options.output, as_csv(test, tracker));
  if (options.json) {
    fmt::print("{}\n", printable_json(as_json(test).dump(2)));
  } else {
    fmt::print("{}", reported(test, tracker));
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
