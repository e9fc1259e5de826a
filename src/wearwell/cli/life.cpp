#include "wearwell/cli/life.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/cli/carried.h"
#include "wearwell/cli/followed_result.h"
#include "wearwell/cli/life_against.h"
#include "wearwell/cli/life_readings.h"
#include "wearwell/input/option_value.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/table.h"
#include "wearwell/prognosis/asked_life.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/prognosis/life_text.h"
#include "wearwell/prognosis/tracked_life.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell {
namespace {

using nlohmann::ordered_json;
using prognosis::LifeReadings;
using prognosis::UnitLife;

struct LifeOptions {
  std::filesystem::path result, output, readings, path;
  std::filesystem::path against;
  std::string unit, survived, horizon, risk, confidence, level, sides;
  bool json = false;
};

// The forecast of the quantity with the failure threshold, from the unit's tracker nodes at its
// present state.
present::Table path_ahead(const LifeOptions& options, Models models,
                          const prognosis::CarriedState& state,
                          std::shared_ptr<const prognosis::TrackedUnit> unit) {
  if (!options.survived.empty())
    throw InputError("--path: continues from the last reading; leave out --survived");
  const auto tracker = tracker_of(state, options.result, models);
  const auto seen = tracker->seen();
  const auto is_known = [&](const std::string& name) {
    return std::find(seen.begin(), seen.end(), name) != seen.end();
  };
  const std::string named = tracker->noun() + " ";
  const std::string bare = options.unit.starts_with(named) && !is_known(options.unit)
                               ? options.unit.substr(named.size())
                               : options.unit;
  std::string name = is_known(bare) ? bare : prognosis::new_name(*tracker);
  if (!tracker->refusal(name).empty()) name = seen.front();  // a study of one unit
  if (!unit) unit = tracker->begin(name);
  const Unit &along = tracker->axis().unit, &level = tracker->limit().unit;
  present::Table table{"path",
                       "Forecast",
                       {{tracker->axis().name, along.text},
                        {tracker->limited() + " 5 %", level.text},
                        {tracker->limited() + " 50 %", level.text},
                        {tracker->limited() + " 95 %", level.text}}};
  for (const prognosis::ForecastBand& each :
       unit->ahead(prognosis::places_ahead(unit->forecast()))) {
    table.rows.push_back({from_si(along, each.at), from_si(level, each.level05),
                          from_si(level, each.level50), from_si(level, each.level95)});
  }
  return table;
}

// What was asked, with the readings since the fit.
struct LifeAnswer {
  UnitLife life = {};
  prognosis::LifeReadings since = {};
  std::shared_ptr<const prognosis::Tracker> tracker = {};   // of the part
  std::shared_ptr<const prognosis::TrackedUnit> part = {};  // with its readings
};

LifeAnswer life_asked(const LifeOptions& options, Models models, prognosis::CarriedState& state,
                      const prognosis::LifeQuestion& question) {
  const std::string result = options.result.string();
  if (options.readings.empty())
    return {prognosis::asked_life(state, result, models, question), {}, {}};
  LifeAnswer answer;
  if (auto part = prognosis::asked_part(state, result, models, question.unit)) {
    const std::shared_ptr<prognosis::TrackedUnit> unit = part->tracker->begin(part->name);
    answer.since =
        take_part_readings(options.readings, *part->tracker, part->name, state.source, *unit);
    answer.life = prognosis::tracked_life(*part->tracker, part->name, question, *unit);
    answer.part = unit;
    answer.tracker = std::move(part->tracker);
    return answer;
  }
  answer.since = take_readings(options.result, options.readings, models, state);
  answer.life = prognosis::asked_life(state, result, models, question);
  return answer;
}

int run_against(const LifeOptions& options, Models models) {
  const std::pair<const char*, bool> others[] = {
      {"--survived", !options.survived.empty()}, {"--readings", !options.readings.empty()},
      {"--risk", !options.risk.empty()},         {"--level", !options.level.empty()},
      {"--sides", !options.sides.empty()},       {"--output", !options.output.empty()},
      {"--path", !options.path.empty()}};
  for (const auto& [name, given] : others)
    if (given) throw InputError(fmt::format("{}: is not possible with --against", name));
  return run_life_against({options.result, options.against, printable(options.unit),
                           options.horizon, options.confidence, options.json},
                          models);
}

int run_life(const LifeOptions& options, Models models) {
  if (!options.against.empty()) return run_against(options, models);
  if (!options.confidence.empty()) throw InputError("--confidence: needs --against");
  refuse_overwriting({{"the result", options.result}, {"the readings", options.readings}},
                     {{"--output", options.output}, {"--path", options.path}});
  const auto [question, bounds] =
      prognosis::read_life_request({options.unit, options.survived, options.horizon, options.risk,
                                    options.level, options.sides});
  prognosis::CarriedState state = read_carried(options.result);
  const LifeAnswer answer = life_asked(options, models, state, question);
  const UnitLife& life = answer.life;
  const prognosis::LifeReadings& moved = answer.since;
  std::string path;
  if (!options.path.empty()) path = present::csv(path_ahead(options, models, state, answer.part));
  if (!options.output.empty())
    write_file(options.output, present::csv(prognosis::survival_table(life)));
  if (!options.path.empty()) write_file(options.path, path);
  if (options.json) {
    fmt::print("{}\n",
               printable_json(prognosis::life_json(life, bounds, moved, state.trusted).dump(2)));
  } else {
    fmt::print("{}", prognosis::life_text(life, bounds, moved, state.trusted));
    if (!options.output.empty())
      fmt::print("The survival curve is in {}\n", options.output.string());
    if (!options.path.empty()) fmt::print("The forecast is in {}\n", options.path.string());
  }
  return state.trusted ? 0 : 1;
}

}  // namespace

void add_life_command(CLI::App& app, Models models, int& exit_code) {
  auto options = std::make_shared<LifeOptions>();
  CLI::App* life =
      app.add_subcommand("life", "Remaining useful life of one unit, or the life of a new one");
  life->add_option("RESULT", options->result, "Folder that fit or update wrote, or its state.bin")
      ->required();
  life->add_option(
      "--unit", options->unit,
      "Whose life: a label of the data (a machine, a bearing, a part that did not break), or a "
      "stress of an S-N study (default: a new unit; for a joint, the joint)");
  life->add_option("--survived", options->survived,
                   "Use that it has survived, with its unit (default: its last reading)");
  life->add_option("--readings", options->readings, "Table of readings since the fit")
      ->type_name("FILE");
  life->add_option("--horizon", options->horizon,
                   "Reports the probability that the end is reached within this use, from now on");
  life->add_option("--risk", options->risk,
                   "Risk tolerated until the next inspection (default: as in the study, or 1 %)");
  life->add_option("--level", options->level,
                   "Adds a bound of this life that holds with this probability, like \"95 %\"");
  life->add_option("--sides", options->sides,
                   "Which bound: lower, upper, or both ends of an interval (default: lower)");
  life->add_option("--against", options->against,
                   "Compare new units with those of another result: ratios of B-lives, the "
                   "probability to outlive one of them, with --horizon the difference of survival")
      ->type_name("RESULT");
  life->add_option("--confidence", options->confidence,
                   "Of the column 'at least' of --against (default: 90 %)");
  life->add_option("-o,--output", options->output, "Write the survival curve as CSV")
      ->type_name("FILE");
  life->add_option("--path", options->path,
                   "Write the forecast as CSV: 5, 50 and 95 % quantiles of the quantity with the "
                   "failure threshold (formula model, bearing, joint, part)")
      ->type_name("FILE");
  life->add_flag("--json", options->json, "Print one JSON object and nothing else");
  life->footer(
      "Examples:\n"
      "  wearwell life study-results --unit J7 --survived \"1e4 cycles\" --horizon \"500 cycles\"\n"
      "  wearwell life study-results --unit J7 --readings today.csv --risk \"1 %\" --json\n"
      "  wearwell life study-results --unit J7 --level \"95 %\" --sides both\n"
      "  wearwell life bearing-results --unit B --path path.csv\n"
      "  wearwell life sn-results --unit shaft --survived \"2e5 cycles\"\n"
      "  wearwell life fluid-results --horizon \"100 h\"      (does the next one fail within 100 "
      "h?)\n"
      "  wearwell life fluid-results --survived \"100 h\"     (probability of an earlier end, and "
      "the RUL)\n"
      "  wearwell life new-results --against old-results --horizon \"100 h\"     (is the new one "
      "better?)\n\n"
      "Exit codes: 0 done; 1 done, but a check of the fit had failed; 2 the request is wrong; 3 "
      "the machine failed.");
  life->callback([options, models, &exit_code] { exit_code = run_life(*options, models); });
}

}  // namespace wearwell
