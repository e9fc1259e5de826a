#include "wearwell/cli/life_against.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/cli/carried.h"
#include "wearwell/input/option_value.h"
#include "wearwell/present/table.h"
#include "wearwell/prognosis/lives_against.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {
namespace {

using nlohmann::ordered_json;
using prognosis::ComparedValue;

// A life of a result. The posterior and the study live here.
struct Compared {
  prognosis::CarriedState state;
  std::unique_ptr<const Study> read;
  prognosis::NamedLife life;
  std::string of;  // "supplier-a-results, valve"

  Compared(const std::filesystem::path& result, const std::string& unit, Models models)
      : state(read_carried(result)), read(read_study(state.source, models)) {
    const auto lives = prognosis::named_lives(require_posterior_study(*read));
    if (lives.empty())
      throw InputError(
          fmt::format("{}: this study has no life of a new unit to compare; state one "
                      "under [predict]",
                      result.string()));
    life = prognosis::life_named(lives, unit, result.string() + ": --unit");
    const std::string at = life.request->at.empty() ? "" : " " + life.request->at;
    of = printable(
        fmt::format("{}, {}{}", result.string(), prognosis::without_new(life.request->of), at));
  }
};

double confidence_of(const std::string& text) {
  const double confidence = option_value("--confidence", text, "1", Allowed::positive);
  if (!(confidence < 1))
    throw InputError(fmt::format("--confidence: {} must lie between 0 and 100 %", text));
  return std::round(confidence * 1e12) / 1e12;  // 0.95, not 0.9500000000000001, of 95 %
}

void refuse_other_dimension(const Unit& unit, const Unit& other) {
  const auto a = parse_unit(unit.text), b = parse_unit(other.text);
  if (unit.text != other.text && !(a && b && a->dimension == b->dimension))
    throw InputError(
        fmt::format("--against: lives in {} and in {} cannot be compared", unit.text, other.text));
}

// The library writes null for infinite numbers.
ordered_json json_of(const ComparedValue& value) {
  return {{"q05", value.q05},   {"q50", value.q50},        {"q95", value.q95},
          {"mean", value.mean}, {"at_least", value.lower}, {"better", value.larger}};
}

ordered_json json_of(const prognosis::LivesAgainst& found, const Compared& life,
                     const Compared& other, double use) {
  ordered_json json = {{"of", life.of},
                       {"against", other.of},
                       {"trusted", life.state.trusted && other.state.trusted},
                       {"confidence", found.confidence},
                       {"outlives", json_of(found.outlives)},
                       {"ratios", ordered_json::array()},
                       {"without_ratio", found.without_ratio}};
  for (const auto& each : found.ratios) {
    ordered_json ratio = json_of(each.of);
    ratio["percent"] = each.percent;
    json["ratios"].push_back(std::move(ratio));
  }
  if (found.survival) {
    json["survival_difference"] = json_of(*found.survival);
    json["survival_difference"]["at"] = use;
    json["survival_difference"]["unit"] = life.life.request->unit.text;
  }
  return json;
}

present::Table table_of(const prognosis::LivesAgainst& found, const std::string& use) {
  const present::Format share = present::digits(3);
  present::Table table{"against",
                       "The first against the other",
                       {{"", "1", {}},
                        {fmt::format("at least, {:.6g} %", 100 * found.confidence), "1", share},
                        {"5 %", "1", share},
                        {"50 %", "1", share},
                        {"95 %", "1", share},
                        {"better [%]", "1", share}}};
  const auto add = [&](const std::string& name, const ComparedValue& value, double scale) {
    table.rows.push_back({name, scale * value.lower, scale * value.q05, scale * value.q50,
                          scale * value.q95, 100 * value.larger});
  };
  for (const auto& each : found.ratios)
    add(fmt::format("B{:.6g} life, as a multiple", each.percent), each.of, 1);
  add("probability to outlive one of the other [%]", found.outlives, 100);
  if (found.survival) add("survival to " + use + ", difference [%]", *found.survival, 100);
  return table;
}

}  // namespace

int run_life_against(const LifeAgainstOptions& options, Models models) {
  const double confidence = options.confidence.empty() ? 0.9 : confidence_of(options.confidence);
  const Compared life(options.result, options.unit, models);
  const Compared other(options.against, options.unit, models);
  const Unit& unit = life.life.request->unit;
  refuse_other_dimension(unit, other.life.request->unit);
  std::optional<double> use;
  if (!options.horizon.empty())
    use = unit.scale * prognosis::along_life("--horizon", options.horizon, unit.text);
  const prognosis::LivesAgainst found = prognosis::lives_against(
      {life.life, life.state.posterior}, {other.life, other.state.posterior}, confidence, use);
  const bool trusted = life.state.trusted && other.state.trusted;
  if (options.json) {
    fmt::print("{}\n",
               printable_json(json_of(found, life, other, use.value_or(0) / unit.scale).dump(2)));
    return trusted ? 0 : 1;
  }
  for (const Compared* each : {&life, &other})
    if (!each->state.trusted)
      fmt::print("Not trusted: a check of the fit of {} failed; its summary names it.\n", each->of);
  fmt::print("Life of {}\nagainst {}\n\n{}", life.of, other.of,
             present::text(table_of(found, options.horizon)));
  fmt::print("  better: the probability that the first is better in this respect\n");
  for (const double percent : found.without_ratio)
    fmt::print("  B{:.6g} lives have no ratio: for some parameters neither is ever reached.\n",
               percent);
  fmt::print("Of the next two, that of {} lives longer with probability {}.\n",
             options.result.string(), probability_text(found.outlives.mean));
  return trusted ? 0 : 1;
}

}  // namespace wearwell
