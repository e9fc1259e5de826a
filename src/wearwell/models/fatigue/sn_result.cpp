#include "wearwell/models/fatigue/sn_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/json_reader.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/study/header_json.h"
#include "wearwell/study/saved_result.h"

namespace wearwell::fatigue {
namespace {

using Json = nlohmann::ordered_json;

// By the order of LifeFamily and of StandardDistribution.
constexpr const char* families[] = {"log10-normal", "weibull", "normal"};
constexpr const char* limit_families[] = {"normal", "smallest-extreme-value"};
// Of SnCurve and SecondSlope.
constexpr const char* curves[] = {"basquin", "knee", "stromeyer", "bastenaire", "strain-life"};
constexpr const char* second_slopes[] = {"free", "haibach", "infinite"};

template <class Choice>
Choice chosen(const JsonReader& json, std::initializer_list<const char*> names) {
  const std::string name = json.one_of(names);
  return static_cast<Choice>(std::find(names.begin(), names.end(), name) - names.begin());
}

TestedSpan span_of(const LifeTests& tests) {
  TestedSpan span{INFINITY, 0, INFINITY, -INFINITY, INFINITY, 0};
  for (const LifeTest& test : tests) {
    span.alternating_low = std::min(span.alternating_low, test.stress.alternating);
    span.alternating_high = std::max(span.alternating_high, test.stress.alternating);
    span.mean_low = std::min(span.mean_low, test.stress.mean);
    span.mean_high = std::max(span.mean_high, test.stress.mean);
    span.life_low = std::min(span.life_low, test.life);
    span.life_high = std::max({span.life_high, test.life, test.until});
    span.tests += test.count;
    span.failures += test.outcome == Outcome::failure ? test.count : 0;
  }
  return span;
}

SnLaw read_law(const JsonReader& json) {
  SnLaw law;
  const auto correction = mean_stress_named(json.at("mean_stress").text());
  if (!correction) json.at("mean_stress").fail("is not a mean-stress correction");
  law.correction = *correction;
  const std::string family = json.at("family").one_of({families[0], families[1], families[2]});
  law.family = family == families[0]   ? LifeFamily::log10_normal
               : family == families[1] ? LifeFamily::weibull
                                       : LifeFamily::normal;
  if (const auto strength = json.find("strength")) law.strength = strength->positive();
  if (const auto gamma = json.find("gamma")) law.gamma = gamma->number();
  if (json.at("fatigue_limit").one_of({"none", "random"}) == "random")
    law.limit =
        json.at("limit_family").one_of({limit_families[0], limit_families[1]}) == limit_families[0]
            ? StandardDistribution::normal
            : StandardDistribution::smallest_extreme_value;
  if (const auto curve = json.find("curve"))
    law.curve = chosen<SnCurve>(*curve, {curves[0], curves[1], curves[2], curves[3], curves[4]});
  if (const auto slope = json.find("second_slope"))
    law.second_slope =
        chosen<SecondSlope>(*slope, {second_slopes[0], second_slopes[1], second_slopes[2]});
  if (const auto scatter = json.find("scatter"))
    law.scatter_grows = scatter->one_of({"constant", "grows"}) == "grows";
  return law;
}

std::pair<double, double> read_span(const JsonReader& json, const Unit& unit) {
  const std::vector<double> ends = json.numbers();
  if (ends.size() != 2 || ends[0] > ends[1]) json.fail("should be two numbers, the smaller first");
  return {to_si(unit, ends[0]), to_si(unit, ends[1])};
}

}  // namespace

nlohmann::ordered_json sn_json(const SnLaw& law, const SnData& data) {
  Json json = {{"mean_stress", mean_stress_names()[static_cast<std::size_t>(law.correction)]},
               {"family", families[static_cast<int>(law.family)]},
               {"fatigue_limit", law.limit ? "random" : "none"}};
  if (law.limit)
    json["limit_family"] = limit_families[*law.limit == StandardDistribution::normal ? 0 : 1];
  if (law.curve != SnCurve::basquin) json["curve"] = curves[static_cast<int>(law.curve)];
  if (law.curve == SnCurve::knee)
    json["second_slope"] = second_slopes[static_cast<int>(law.second_slope)];
  if (law.scatter_grows) json["scatter"] = "grows";
  if (law.strength) json["strength"] = *law.strength;
  if (law.gamma) json["gamma"] = *law.gamma;
  const TestedSpan span = span_of(data.tests);
  const auto stress = [&](double si) { return from_si(data.stress_unit, si); };
  json["stress_unit"] = data.stress_unit.text;
  json["life_unit"] = data.life_unit.text;
  json["tested"] = {
      {"tests", span.tests},
      {"failures", span.failures},
      {"alternating", {stress(span.alternating_low), stress(span.alternating_high)}},
      {"mean", {stress(span.mean_low), stress(span.mean_high)}},
      {"life", {from_si(data.life_unit, span.life_low), from_si(data.life_unit, span.life_high)}}};
  return json;
}

SnResult sn_result_of(const Json& summary, const std::filesystem::path& file,
                      const std::string& name,
                      const std::function<prognosis::CarriedState()>& read_state) {
  const JsonReader root(summary, file);
  const Header header = read_header(root);
  if (header.model != "sn")
    throw InputError(fmt::format("{}: its model is \"{}\"; an S-N curve is needed, model \"sn\"",
                                 name, header.model));
  const auto json = root.find("fatigue");
  if (!json)
    throw InputError(fmt::format(
        "{} has no \"fatigue\": an earlier wearwell wrote it; fit the study again", file.string()));
  SnResult result{header.title,
                  header.equation,
                  header.trusted,
                  read_law(*json),
                  {},
                  {},
                  {},
                  {},
                  driver_si(json->at("stress_unit").text())};
  if (result.stress_si.empty()) json->at("stress_unit").fail("is not a unit of a stress");
  result.stress_unit = read_unit(json->at("stress_unit").text(), result.stress_si);
  const JsonReader tested = json->at("tested");
  TestedSpan& span = result.tested;
  std::tie(span.alternating_low, span.alternating_high) =
      read_span(tested.at("alternating"), result.stress_unit);
  std::tie(span.mean_low, span.mean_high) = read_span(tested.at("mean"), result.stress_unit);
  result.life_unit = life_unit(read_unit(json->at("life_unit").text(), "cycle"));
  std::tie(span.life_low, span.life_high) = read_span(tested.at("life"), result.life_unit);
  span.tests = static_cast<int>(tested.at("tests").integer(1, 1 << 30));
  span.failures = static_cast<int>(tested.at("failures").integer(0, span.tests));

  for (const auto& [parameter, each] : root.at("parameters").members())
    result.parameters.push_back(parameter);
  if (std::ssize(result.parameters) != result.law.dimension())
    throw InputError(fmt::format("{}: {} parameters do not match the named model", file.string(),
                                 result.parameters.size()));
  prognosis::CarriedState state = read_state();
  prognosis::require_parameters(state, result.parameters);
  result.posterior.values = std::move(state.posterior.values);
  result.posterior.weights = std::move(state.posterior.weights);
  return result;
}

SnResult read_sn_result(const std::filesystem::path& folder) {
  const std::filesystem::path file = summary_file(folder);
  return sn_result_of(read_json(file), file, folder.string(),
                      [&] { return prognosis::read_state(folder); });
}

}  // namespace wearwell::fatigue
