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
#include "wearwell/cli/life_bounds.h"
#include "wearwell/cli/life_readings.h"
#include "wearwell/input/option_value.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/table.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/prognosis/tracked_life.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell {
namespace {

using nlohmann::ordered_json;
using prognosis::UnitLife;

struct LifeOptions {
  std::filesystem::path result, output, readings, path;
  std::filesystem::path against;
  std::string unit, survived, horizon, risk, confidence, level, sides;
  bool json = false;
};

double risk_of(const std::string& text) {
  const double risk = option_value("--risk", text, "1", Allowed::positive);
  if (!(risk < 1)) throw InputError(fmt::format("--risk: {} must lie between 0 and 1", text));
  return risk;
}

// 0.93 instead of 0.9299999999999999.
double survival(double share) {
  constexpr double digits = 1e12;
  return std::round((1 - share) * digits) / digits;
}

ordered_json json_of(const UnitLife& life, const LifeBounds& bounds, const ReadingsSince& moved,
                     bool trusted) {
  ordered_json json = {{"of", life.of},
                       {"name", life.name},
                       {"at", life.at},
                       {"unit", life.unit},
                       {"trusted", trusted}};
  if (life.from) json["from"] = *life.from;
  if (life.passed) json["passed"] = *life.passed;
  if (life.never) json["never"] = *life.never;
  for (const auto& [key, p] : {std::pair{"q05", 0.05},
                               {"q50", 0.5},
                               {"q95", 0.95},
                               {"b1", 0.01},
                               {"b10", 0.1},
                               {"b50", 0.5}})
    json[key] = life.quantile(p);
  if (life.numerical_error) json["numerical_error"] = *life.numerical_error;
  if (bounds.asked) json.update(bounds_json(life, bounds));
  json["risk"] = life.risk;
  json["inspect_within"] = life.inspect_within;
  if (life.horizon) json["horizon"] = {{"within", *life.horizon}, {"reached", *life.reached}};
  json["survival"] = ordered_json::array();
  for (std::size_t i = 0; i < life.share.size(); ++i)
    json["survival"].push_back({{"life", life.life[i]}, {"survival", survival(life.share[i])}});
  if (moved.how.empty()) return json;
  json["readings"] = {{"counted", moved.counted},
                      {"repeated", moved.repeated},
                      {"how", moved.how},
                      {"contradictions", ordered_json::array()}};
  for (const prognosis::Contradiction& each : moved.contradictions)
    json["readings"]["contradictions"].push_back({{"place", each.place}, {"why", each.why}});
  return json;
}

present::Table table_of(const UnitLife& life) {
  present::Table table{
      "survival", "Survival", {{life.name, life.unit, present::life()}, {"survival", "1"}}};
  for (std::size_t i = 0; i < life.share.size(); ++i)
    table.rows.push_back({life.life[i], survival(life.share[i])});
  return table;
}

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

void print(const UnitLife& life, const LifeBounds& bounds, const ReadingsSince& moved,
           bool trusted) {
  const std::string unit = printable(unit_description(life.unit, Script::terminal));
  const int digits = digits_within(life.numerical_error.value_or(0));
  const auto shown = [&](double value) {
    return std::isfinite(value) ? plain_number(value, digits) : std::string("never");
  };
  if (!trusted)
    fmt::print(
        "Not trusted: a check of the fit failed; wearwell report or the summary names it.\n");
  fmt::print("{} of {} {}\n", life.name == "life" ? "Life" : "Remaining useful life", life.of,
             life.at);
  if (life.from) {
    const double place = std::strtod(fmt::format("{:.6g}", *life.from).c_str(), nullptr);
    fmt::print("  counted from {} {}\n", plain_given(place), unit);
  }
  if (!moved.how.empty())
    fmt::print("  with {} new reading{} ({} known already); {}\n", moved.counted,
               moved.counted == 1 ? "" : "s", moved.repeated, moved.how);
  if (life.passed)
    fmt::print("  probability of an earlier end: {}; given no earlier end:\n",
               probability_text(*life.passed));
  if (life.never)
    fmt::print("  probability that it never ends: {}\n", probability_text(*life.never));
  for (const prognosis::Contradiction& each : moved.contradictions)
    fmt::print("  check {}: {}\n", each.place, each.why);
  const auto with_unit = [&](double value) {
    return std::isfinite(value) ? shown(value) + " " + unit : shown(value);
  };
  fmt::print("  median {}, {} to {} (90 %)\n", with_unit(life.quantile(0.5)),
             shown(life.quantile(0.05)), with_unit(life.quantile(0.95)));
  if (bounds.asked) fmt::print("  {}\n", bound_text(life, bounds.levels, with_unit));
  fmt::print("  B1 {}   B10 {}   B50 {}\n", shown(life.quantile(0.01)), shown(life.quantile(0.1)),
             shown(life.quantile(0.5)));
  if (life.numerical_error.value_or(0) > least_numerical_error)
    fmt::print("  numerical error of these lives: {} %\n",
               plain_number(100 * *life.numerical_error, 2));
  if (life.horizon)
    fmt::print("  probability of reaching the end within {} {}: {}\n", plain_given(*life.horizon),
               unit, probability_text(*life.reached));
  if (std::isfinite(life.inspect_within))
    fmt::print("  inspect again within {}: {} risk of reaching the end before\n",
               with_unit(life.inspect_within), probability_text(life.risk));
  else
    fmt::print("  no inspection is due: the risk of ever reaching the end is below {}\n",
               probability_text(life.risk));
}

// The name of a part may also be that of a stress.
void refuse_two_meanings(const prognosis::CarriedState& state, const std::string& name,
                         const std::string& asked) {
  if (name != asked) return;  // "part shaft"
  const auto predict = TomlReader::parse(state.source.study).table("predict");
  const auto stresses = predict ? predict->table("stress") : std::nullopt;
  if (stresses && stresses->has(name))
    throw InputError(
        fmt::format("--unit: '{0}' is both a part of the data and a stress of [predict.stress]: "
                    "write 'part {0}' for the part, or rename the stress",
                    printable(name)));
}

// A named part of an S-N study, found by its name.
struct PartAsked {
  std::unique_ptr<const prognosis::Tracker> tracker;
  std::string name;
};
std::optional<PartAsked> part_asked(const LifeOptions& options, Models models,
                                    const prognosis::CarriedState& state,
                                    const std::string& asked) {
  if (state.model != "sn" || asked.empty()) return {};
  auto tracker = tracker_of(state, options.result, models);
  const auto name = prognosis::tracked_name(*tracker, asked);
  if (!name) return {};
  refuse_two_meanings(state, *name, asked);
  return PartAsked{std::move(tracker), *name};
}

// What was asked, with the readings since the fit.
struct LifeAnswer {
  UnitLife life = {};
  ReadingsSince since = {};
  std::shared_ptr<const prognosis::TrackedUnit> part = {};  // with its readings
};

LifeAnswer life_asked(const LifeOptions& options, Models models, prognosis::CarriedState& state,
                      const prognosis::LifeQuestion& question) {
  LifeAnswer answer;
  if (const auto part = part_asked(options, models, state, question.unit)) {
    const std::shared_ptr<prognosis::TrackedUnit> unit = part->tracker->begin(part->name);
    if (!options.readings.empty())
      answer.since =
          take_part_readings(options.readings, *part->tracker, part->name, state.source, *unit);
    answer.life = prognosis::tracked_life(*part->tracker, part->name, question, *unit);
    if (!options.readings.empty()) answer.part = unit;
    return answer;
  }
  if (!options.readings.empty())
    answer.since = take_readings(options.result, options.readings, models, state);
  const prognosis::ReadAsked read = [&](const Source& source) {
    return read_study(source, models);
  };
  answer.life = prognosis::unit_life(state.source, read, state.posterior, question);
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
  prognosis::LifeQuestion question;
  question.unit = printable(options.unit);  // read as tables are
  if (!options.survived.empty()) question.survived = options.survived;
  if (!options.horizon.empty()) question.horizon = options.horizon;
  if (!options.risk.empty()) question.risk = risk_of(options.risk);
  const LifeBounds bounds = read_life_bounds(options.level, options.sides);
  if (bounds.asked) question.shares = {bounds.levels.below(), 1 - bounds.levels.below()};
  prognosis::CarriedState state = read_carried(options.result);
  const LifeAnswer answer = life_asked(options, models, state, question);
  const UnitLife& life = answer.life;
  const ReadingsSince& moved = answer.since;
  std::string path;
  if (!options.path.empty()) path = present::csv(path_ahead(options, models, state, answer.part));
  if (!options.output.empty()) write_file(options.output, present::csv(table_of(life)));
  if (!options.path.empty()) write_file(options.path, path);
  if (options.json) {
    fmt::print("{}\n", printable_json(json_of(life, bounds, moved, state.trusted).dump(2)));
  } else {
    print(life, bounds, moved, state.trusted);
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
