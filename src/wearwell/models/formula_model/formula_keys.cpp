#include "wearwell/models/formula_model/formula_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/models/formula_model/formula_process.h"
#include "wearwell/models/formula_model/returns_keys.h"
#include "wearwell/prob/response.h"
#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_keys.h"

namespace wearwell::formula_model {
namespace {

// One entry per name, with the families that have such a parameter.
StudyKeys parameter_keys() {
  std::vector<std::pair<std::string, std::vector<std::string>>> family_parameters;
  const auto add = [&](const ResponseForm& form) {
    for (const ParameterForm& family_parameter : form.family_parameters) {
      const std::string name(family_parameter.name), family(form.name);
      auto at = std::find_if(family_parameters.begin(), family_parameters.end(),
                             [&](const auto& each) { return each.first == name; });
      if (at == family_parameters.end())
        at = family_parameters.insert(family_parameters.end(), {name, {}});
      if (at->second.empty() || at->second.back() != family) at->second.push_back(family);
    }
  };
  for (const ResponseForm& each : response_forms()) add(each);
  for (const ProcessForm& each : process_forms()) add(each.form);
  StudyKeys keys;
  for (const auto& [name, families] : family_parameters) {
    keys.push_back({"likelihood.*." + name, fmt::format("\"{}\"", name == "mean" ? "wear" : name),
                    fmt::format("expression or number, of {}", fmt::join(families, ", "))});
  }
  return keys;
}

}  // namespace

StudyKeys formula_keys() {
  StudyKeys keys = posterior_keys();
  add_keys(keys, status_keys());
  add_keys(keys, {{"data.columns.*", "{ column = \"h_um\", unit = \"um\" }",
                   "the name in expressions; `status`, `lower`, `upper`, `count` and `entry` "
                   "qualify an observation"},
                  {"data.columns.*.detection_limit", "\"0.05 mm^3\"",
                   "value of `<LOD` in its cells: the measured value lies below"},
                  unused_columns_key(),
                  {"data.rows_of", "\"machine\"",
                   "the label that identifies the units, if several have random effects"},
                  {"constants.*", "\"50 mm^2\"", "a number with its unit, or a plain number"},
                  {"formula.*", "\"k * work / area\"",
                   "intermediate value, or a state given by its rate `\"d(depth)/d(distance)\"` "
                   "([formula-language.md](formula-language.md))"},
                  {"likelihood.*", "{ family = \"normal\", mean = \"wear\", sd = \"sigma\" }",
                   "one table per measured column"},
                  needed_key("likelihood.*.family", "\"normal\"", "distribution of its scatter",
                             {"failure_modes", "subpopulations"})});
  add_keys(keys, parameter_keys());
  add_keys(
      keys,
      {{"likelihood.*.share_defective", "\"p\"",
        "expression or number: the share of parts that can fail at all (limited failure "
        "population, "
        "[life.md](life.md#subpopulations))"},
       {"likelihood.*.share_dead_on_arrival", "\"d\"",
        "expression or number: the share of parts that are dead on arrival; a life of 0 is such a "
        "part"},
       {"subpopulations", "{ names = [\"early\", \"wear-out\"], share = { early = \"p\" } }",
        "a mixture: a part is of one of these, unknown which "
        "([life.md](life.md#subpopulations))"},
       needed_key("subpopulations.names", "[\"early\", \"wear-out\"]",
                  "in the order of their median lives", {}, {"subpopulations"}),
       {"subpopulations.share", "{ early = \"p\" }",
        "the shares of all but one, which has the rest"},
       {"subpopulations.share.*", "\"p\"", "expression or number: the share of this one"},
       {"subpopulations.*", "{ family = \"lognormal\", median = \"m\", log_sd = \"s\" }",
        "distribution of one subpopulation, by its name; the others have that of `likelihood`, "
        "where "
        "`scale[subpopulation]` is a parameter of each"},
       {"subpopulations.*.family", "\"lognormal\"", "distribution of its life"},
       {"subpopulations.*.*", "\"m\"", "expression or number, of the parameters of the family"},
       {"use_rate", "{ age = \"age\", family = \"lognormal\", median = \"r\", log_sd = \"s\" }",
        "the life is in use, and units differ in use per time; a row may have an age alone "
        "([life.md](life.md#use-rates))"},
       needed_key("use_rate.age", "\"age\"",
                  "column of ages under data.columns; the life may be empty", {}, {"use_rate"}),
       needed_key("use_rate.family", "\"lognormal\"",
                  "distribution of use over age: lognormal, weibull or gamma", {}, {"use_rate"}),
       {"use_rate.*", "\"r\"", "expression or number, of the parameters of the family"},
       {"failure_modes", "{ column = \"mode\" }",
        "competing risks: a part fails by the mode whose life ends first "
        "([life.md](life.md#failure-modes))"},
       needed_key("failure_modes.column", "\"mode\"",
                  "column of the failure modes under data.columns; an empty cell is any mode", {},
                  {"failure_modes"}),
       {"failure_modes.runout", "\"censored\"",
        "words of this column that mark run-outs, if no status column does"},
       {"failure_modes.unknown", "\"n/a\"", "words of this column for a failure of unknown mode"},
       {"failure_modes.*", "{ family = \"lognormal\", median = \"m\", log_sd = \"s\" }",
        "distribution of one mode, by its name; the other modes have that of `likelihood`, where "
        "`slope[mode]` is a parameter of each"},
       needed_key("failure_modes.*.family", "\"lognormal\"", "distribution of its life"),
       {"failure_modes.*.*", "\"m\"", "expression or number, of the parameters of the family"}});
  add_keys(
      keys,
      {needed_key("likelihood.*.trials", "\"trials\"", "column of their numbers", {},
                  {".family=binomial"}),
       {"likelihood.*.steps", "\"specimen\"",
        "column of the specimens of a step-stress test, whose rows are the steps"},
       needed_key("likelihood.*.standard", "\"normal\"",
                  "distribution of the standardized logarithm "
                  "([distributions.md](distributions.md#log-location-scale-families-and-names-"
                  "elsewhere))",
                  {}, {".family=log-location-scale"}),
       {"likelihood.*.ramp", "{ stress = \"voltage\", start = \"0 kV\", rate = \"ramp\" }",
        "a test under a stress that rises in proportion to time, a row for each specimen "
        "([life.md](life.md#ramp-tests))"},
       needed_key("likelihood.*.ramp.stress", "\"voltage\"",
                  "name of the stress in expressions, which has no column", {}, {".start"}),
       needed_key("likelihood.*.ramp.start", "\"0 kV\"",
                  "stress at the beginning: a column under data.columns or a quantity", {},
                  {".stress"}),
       needed_key("likelihood.*.ramp.rate", "\"ramp\"",
                  "change of the stress per time: a column under data.columns or a quantity", {},
                  {".stress"}),
       {"prior.*", "{ distribution = \"lognormal\", median = \"1e-6 mm^3/(N m)\", log_sd = 2 }",
        "one per parameter; `k` or `\"k[PTFE]\"` for one of each level"},
       {"random_effects.*", "{ k = { distribution = \"lognormal\", log_sd = \"k_scatter\" } }",
        "random effects over the levels of this label"},
       {"random_effects.*.*", "{ distribution = \"lognormal\", log_sd = \"k_scatter\" }",
        "of this parameter"},
       needed_key("random_effects.*.*.distribution", "\"lognormal\"",
                  "distribution around the parameter of this name"),
       needed_key("random_effects.*.*.log_sd", "\"k_scatter\"",
                  "expression, for a lognormal distribution", {}, {".distribution=lognormal"}),
       needed_key("random_effects.*.*.sd", "\"a_scatter\"", "expression, for a normal distribution",
                  {}, {".distribution=normal"}),
       {"random_effects.*.correlation", "\"rho\"", "of two random effects"},
       {"predict.along", "\"distance\"", "column that is the axis of wear and life"},
       {"predict.at", "[\"10 km\", \"50 km\"]", "positions of future measurements"},
       {"predict.units", "[\"3\", \"7\"]",
        "only these units, with future measurements: reported at predict.at"},
       {"predict.given.*", "\"20 N\"", "a condition; all others must be the same in all rows"},
       {"predict.given.*.distribution", "\"normal\"",
        "of a condition that differs between units: a life is that of a unit with its own"},
       {"predict.given.*.values", "[\"20 degC\", \"35 degC\"]",
        "conditions of the units, in place of a distribution"},
       {"predict.given.*.shares", "[0.7, 0.3]",
        "share or number of units of each; equal by default"},
       {"predict.given.*.*", "\"5 K\"", "parameter or bound of the distribution, as in `[prior]`"},
       {"predict.limit.*", "\"100 um\"", "failure threshold of this expression: gives lives"},
       {"predict.rate_change", "{ every = \"20000 h\", factor = \"1 x/ 2\" }",
        "the rate of a unit on line may change ([rate-change.md](../how-to/rate-change.md))"},
       needed_key("predict.rate_change.every", "\"20000 h\"", "mean use until a change", {},
                  {"predict.rate_change"}),
       needed_key("predict.rate_change.factor", "\"1 x/ 2\"",
                  "new rate as a multiple of the earlier one: median, and factor within which two "
                  "thirds lie",
                  {}, {"predict.rate_change"}),
       {"predict.lives_of", "[\"3\", \"7\"]",
        "lives to the threshold of these units only; [] for a new unit only"},
       {"predict.b_lives", "[1, 10]",
        "percentages failed, for a likelihood of a life or for lives to the threshold"},
       {"predict.mean_life", "true",
        "reports the mean life (MTTF) and the mean remaining useful life, of a likelihood of a "
        "life or to the threshold"},
       {"predict.survived", "\"1000 h\"", "survived use: lives from there on"},
       {"predict.survival_to", "\"1000 h\"", "share that outlasts it, one or several"},
       {"predict.hazard_at", "\"1000 h\"", "hazard rate at this life"},
       {"predict.calendar", "{ survival_to = [\"36 month\"] }",
        "of the life in calendar time, with `[use_rate]`"},
       {"predict.calendar.survival_to", "[\"36 month\"]", "share that outlasts it, one or several"},
       {"predict.calendar.survived", "\"12 month\"", "survived age: lives from there on"},
       {"predict.warranty", "{ age = \"36 month\", use = \"60000 km\" }",
        "with `[use_rate]`: the share that fails within both"},
       needed_key("predict.warranty.age", "\"36 month\"", "its end in time", {},
                  {"predict.warranty"}),
       needed_key("predict.warranty.use", "\"60000 km\"", "its end in use", {},
                  {"predict.warranty"}),
       {"predict.classical", "true",
        "of a likelihood of a life: maximum likelihood with bounds, median rank regression and "
        "Kaplan-Meier beside the posterior"},
       {"predict.accelerated.*", "\"80 degC\"",
        "conditions of a test, for the acceleration factor"},
       {"predict.accelerated.*.*", "\"normal\"", "as under `predict.given.*`"},
       {"predict.compared_with.*.*", "\"normal\"", "as under `predict.given.*`"},
       {"predict.compared_with.*", "\"old\"",
        "conditions of a life to compare with: probability to outlive it, ratios of B-lives, "
        "differences of survival"},
       {"predict.quantities.*", "\"exp(k_scatter^2/2)\"",
        "any function of the parameters; or with its unit:"},
       {"predict.quantities.*.value", "\"k * 20 [N]\"", "expression"},
       {"predict.quantities.*.unit", "\"mm^3/m\"", "unit of the report"}});
  add_keys(keys, level_keys("B-lives, mean lives and survival, and of predict.classical"));
  add_keys(keys, returns_keys());
  return keys;
}

}  // namespace wearwell::formula_model
