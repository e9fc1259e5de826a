#include "wearwell/models/formula_model/formula_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/models/formula_model/formula_process.h"
#include "wearwell/prob/response.h"
#include "wearwell/study/posterior_keys.h"

namespace wearwell::formula_model {
namespace {

// One entry a name, with the families that have a slot of it.
StudyKeys slot_keys() {
  std::vector<std::pair<std::string, std::vector<std::string>>> slots;
  const auto add = [&](const ResponseForm& form) {
    for (const ParameterForm& slot : form.slots) {
      const std::string name(slot.name), family(form.name);
      auto at = std::find_if(slots.begin(), slots.end(),
                             [&](const auto& each) { return each.first == name; });
      if (at == slots.end()) at = slots.insert(slots.end(), {name, {}});
      if (at->second.empty() || at->second.back() != family) at->second.push_back(family);
    }
  };
  for (const ResponseForm& each : response_forms()) add(each);
  for (const ProcessForm& each : process_forms()) add(each.form);
  StudyKeys keys;
  for (const auto& [name, families] : slots) {
    keys.push_back({"likelihood.*." + name, fmt::format("\"{}\"", name == "mean" ? "wear" : name),
                    fmt::format("expression or number, of {}", fmt::join(families, ", "))});
  }
  return keys;
}

}  // namespace

StudyKeys formula_keys() {
  StudyKeys keys = posterior_keys();
  add_keys(keys, status_keys());
  add_keys(
      keys,
      {{"data.columns.*", "{ column = \"h_um\", unit = \"um\" }",
        "what expressions call `*`; `status`, `lower`, `upper`, `count` and `entry` say how much "
        "is "
        "known of an observation"},
       {"data.columns.*.detection_limit", "\"0.05 mm^3\"",
        "what `<LOD` stands for in its cells: the value lies below"},
       unused_columns_key(),
       {"data.rows_of", "\"machine\"",
        "of several labels that parameters vary with: whose levels are the units"},
       {"constants.*", "\"50 mm^2\"", "a number with its unit, or a plain one"},
       {"formula.*", "\"k * work / area\"",
        "intermediate value, or a state by its rate `\"d(depth)/d(distance)\"` "
        "([formula-language.md](formula-language.md))"},
       {"likelihood.*", "{ family = \"normal\", mean = \"wear\", sd = \"sigma\" }",
        "one table a measured column"},
       needed_key("likelihood.*.family", "\"normal\"", "law of its scatter")});
  add_keys(keys, slot_keys());
  add_keys(
      keys,
      {needed_key("likelihood.*.trials", "\"trials\"", "column of their numbers", {},
                  {".family=binomial"}),
       {"prior.*", "{ distribution = \"lognormal\", median = \"1e-6 mm^3/(N m)\", log_sd = 2 }",
        "one a parameter; `k` or `\"k[PTFE]\"` of one of each level"},
       {"random_effects.*", "{ k = { distribution = \"lognormal\", log_sd = \"k_scatter\" } }",
        "what differs from level to level of this label"},
       {"random_effects.*.*", "{ distribution = \"lognormal\", log_sd = \"k_scatter\" }",
        "of this parameter"},
       needed_key("random_effects.*.*.distribution", "\"lognormal\"",
                  "how it lies about the one of its name"),
       needed_key("random_effects.*.*.log_sd", "\"k_scatter\"", "expression, of a lognormal law",
                  {}, {".distribution=lognormal"}),
       needed_key("random_effects.*.*.sd", "\"a_scatter\"", "expression, of a normal law", {},
                  {".distribution=normal"}),
       {"random_effects.*.correlation", "\"rho\"", "of two that vary"},
       {"predict.along", "\"distance\"", "column that is the axis of wear and life"},
       {"predict.at", "[\"10 km\", \"50 km\"]", "measurements to come there"},
       {"predict.units", "[\"3\", \"7\"]",
        "of these units alone, with measurements to come: reported at predict.at"},
       {"predict.given.*", "\"20 N\"",
        "a condition; what is not named must be the same in all rows"},
       {"predict.limit.*", "\"100 um\"", "when this expression reaches it: lives"},
       {"predict.lives_of", "[\"3\", \"7\"]",
        "lives to the limit of these units alone; [] of a new one alone"},
       {"predict.b_lives", "[1, 10]",
        "percentages that have failed, of a likelihood of a life or of lives to the limit"},
       {"predict.survived", "\"1000 h\"", "lives given that so much was reached, from there on"},
       {"predict.survival_to", "\"1000 h\"", "share that outlasts it, one or several"},
       {"predict.hazard_at", "\"1000 h\"", "rate at which those fail that have come so far"},
       {"predict.credible_level", "0.9", "of lower bounds of B-lives and survival"},
       {"predict.accelerated.*", "\"80 degC\"",
        "conditions of a test, for the acceleration factor"},
       {"predict.quantities.*", "\"exp(k_scatter^2/2)\"",
        "any function of the parameters; or with its unit:"},
       {"predict.quantities.*.value", "\"k * 20 [N]\"", "expression"},
       {"predict.quantities.*.unit", "\"mm^3/m\"", "to report in"}});
  return keys;
}

}  // namespace wearwell::formula_model
