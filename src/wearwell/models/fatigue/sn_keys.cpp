#include "wearwell/models/fatigue/sn_keys.h"

#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_keys.h"

namespace wearwell::fatigue {
namespace {

using Names = std::vector<std::string>;

// Of a column or of [conditions].
Names given(const Names& names) {
  Names paths;
  for (const std::string& name : names) {
    paths.push_back("data.columns." + name);
    paths.push_back("conditions." + name);
  }
  return paths;
}

Names joined(Names a, const Names& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// A stress of every test: a column, or the same for all.
StudyKeys input_keys(const std::string& name, const std::string& column,
                     const std::string& constant, const std::string& meaning, Names unless,
                     const Names& when) {
  unless.push_back("conditions." + name);
  return {needed_key("data.columns." + name, column, meaning, unless, when),
          {"conditions." + name, constant, meaning + ", the same for all tests"}};
}

StudyKeys stress_keys() {
  const Names extremes = given({"max_stress", "min_stress"});
  const Names spring = given({"displacement_amplitude", "displacement_mean"});
  const Names other = joined(extremes, spring);
  StudyKeys keys =
      input_keys("alternating_stress", "{ column = \"alternating_stress\", unit = \"MPa\" }",
                 "\"300 MPa\"", "alternating stress: half of the range", other, {});
  add_keys(keys,
           input_keys("stress_ratio", "\"R\"", "-1", "smallest over largest stress",
                      joined(joined(other, given({"mean_stress"})), {"law.mean_stress=none"}), {}));
  add_keys(keys, {{"data.columns.mean_stress", "{ column = \"mean_stress\", unit = \"MPa\" }",
                   "mean stress, instead of stress_ratio"},
                  {"conditions.mean_stress", "\"0 MPa\"", "mean stress, the same for all tests"}});
  add_keys(keys,
           input_keys("max_stress", "{ column = \"max_stress\", unit = \"MPa\" }", "\"600 MPa\"",
                      "largest stress, with min_stress, instead of an amplitude", {},
                      given({"min_stress"})));
  add_keys(keys,
           input_keys("min_stress", "{ column = \"min_stress\", unit = \"MPa\" }", "\"0 MPa\"",
                      "smallest stress, with max_stress", {}, given({"max_stress"})));
  add_keys(
      keys,
      input_keys("displacement_amplitude", "{ column = \"amplitude\", unit = \"mm\" }", "\"5 mm\"",
                 "amplitude of a helical spring, with displacement_mean, instead of a stress", {},
                 given({"displacement_mean"})));
  add_keys(keys, input_keys("displacement_mean", "{ column = \"mean\", unit = \"mm\" }",
                            "\"10 mm\"", "mean displacement of a helical spring", {},
                            given({"displacement_amplitude"})));
  add_keys(keys,
           {needed_key("conditions.wire_diameter", "\"4 mm\"", "of the spring", {}, spring),
            needed_key("conditions.coil_diameter", "\"30 mm\"", "of the spring, mean", {}, spring),
            needed_key("conditions.active_coils", "6", "of the spring", {}, spring),
            needed_key("conditions.shear_modulus", "\"79 GPa\"", "of the spring", {}, spring)});
  return keys;
}

StudyKeys parameter_keys() {
  const std::string logarithm = "{ distribution = \"normal\", mean = \"3 log10(MPa)\", sd = 0.3 }";
  return {
      {"conditions.S_ut", "\"1200 MPa\"", "ultimate strength, known (goodman, gerber)"},
      {"conditions.S_y", "\"900 MPa\"", "yield strength, known (soderberg)"},
      {"conditions.sigma_f", "\"1500 MPa\"", "true fracture strength, known (morrow)"},
      {"conditions.gamma", "0.5", "Walker's exponent, known (walker)"},
      {"prior.log10_a", "{ distribution = \"normal\", mean = \"3.3 log10(MPa)\", sd = 0.3 }",
       "logarithm of the stress at one cycle"},
      {"prior.b", "{ distribution = \"normal\", mean = -0.1, sd = 0.04 }", "Basquin's exponent"},
      {"prior.sigma", "{ distribution = \"half-normal\", scale = 0.3 }",
       "scatter of log10 life; of life itself with family \"normal\""},
      {"prior.log10_Sut", logarithm, "logarithm of the ultimate strength"},
      {"prior.log10_Sy", logarithm, "logarithm of the yield strength"},
      {"prior.log10_sigma_f", logarithm, "logarithm of the true fracture strength"},
      {"prior.gamma", "{ distribution = \"beta\", alpha = 2, beta = 2 }", "Walker's exponent"},
      {"prior.k", "{ distribution = \"normal\", mean = 8, sd = 3 }", "slope above a knee"},
      {"prior.k2", "{ distribution = \"normal\", mean = 20, sd = 8 }", "slope below a knee"},
      {"prior.log10_N_D", "{ distribution = \"normal\", mean = \"6 log10(cycles)\", sd = 0.4 }",
       "logarithm of a knee's life"},
      {"prior.log10_S_D", "{ distribution = \"normal\", mean = \"2.4 log10(MPa)\", sd = 0.2 }",
       "logarithm of a knee's stress"},
      {"prior.log10_N_B", "{ distribution = \"normal\", mean = \"6 log10(cycles)\", sd = 0.5 }",
       "logarithm of Bastenaire's life"},
      {"prior.log10_B", "{ distribution = \"normal\", mean = \"2 log10(MPa)\", sd = 0.4 }",
       "logarithm of Bastenaire's stress"},
      {"prior.C", "{ distribution = \"normal\", mean = 1, sd = 0.5 }", "Bastenaire's exponent"},
      {"conditions.E", "\"206 GPa\"", "of strain-life: for the cyclic curve"},
      {"prior.log10_elastic", "{ distribution = \"normal\", mean = -2.3, sd = 0.2 }",
       "of strain-life: logarithm of sigma_f'/E"},
      {"prior.log10_plastic", "{ distribution = \"normal\", mean = -0.3, sd = 0.3 }",
       "of strain-life: logarithm of eps_f'"},
      {"prior.c", "{ distribution = \"normal\", mean = -0.6, sd = 0.1 }",
       "of strain-life: the plastic exponent"},
      {"prior.sigma_growth", "{ distribution = \"normal\", mean = 0, sd = 0.15 }",
       "decades by which the scatter grows per decade of life"},
      {"prior.log10_limit", "{ distribution = \"normal\", mean = \"2.3 log10(MPa)\", sd = 0.3 }",
       "logarithm of the fatigue limit"},
      {"prior.sigma_limit", "{ distribution = \"half-normal\", scale = 0.1 }",
       "scatter of the logarithm of the fatigue limit"},
  };
}

// One requested stress.
StudyKeys point_keys() {
  const std::string at = "predict.stress.*";
  const Names other = {".max_stress", ".min_stress", ".displacement_amplitude",
                       ".displacement_mean"};
  return {
      {at, "{ alternating_stress = \"400 MPa\", stress_ratio = -1 }",
       "a stress with a name of your choice: adds its lives"},
      needed_key(at + ".alternating_stress", "\"400 MPa\"",
                 "amplitude of that stress, as the next six keys", other),
      {at + ".stress_ratio", "-1", "smallest over largest stress"},
      {at + ".mean_stress", "\"100 MPa\"", "instead of stress_ratio"},
      needed_key(at + ".max_stress", "\"600 MPa\"", "largest stress, with min_stress", {},
                 {".min_stress"}),
      needed_key(at + ".min_stress", "\"0 MPa\"", "smallest stress, with max_stress", {},
                 {".max_stress"}),
      needed_key(at + ".displacement_amplitude", "\"5 mm\"",
                 "displacement amplitude of a helical spring", {}, {".displacement_mean"}),
      needed_key(at + ".displacement_mean", "\"10 mm\"", "mean displacement of a helical spring",
                 {}, {".displacement_amplitude"}),
  };
}

}  // namespace

StudyKeys study_keys() {
  StudyKeys keys = posterior_keys();
  add_keys(keys, stress_keys());
  add_keys(keys, status_keys());
  add_keys(
      keys,
      {needed_key("data.columns.life", "\"cycles\"",
                  "cycles at which a test ended, or was stopped"),
       {"data.columns.life_until", "\"cycles_until\"", "end of an interval in which it failed"},
       {"data.columns.status", "\"status\"",
        "failure, runout, left or interval; without it all failed"},
       unused_columns_key(),
       {"data.columns.count", "\"count\"", "number of equal tests in a row"},
       {"data.columns.label", "\"type\"", "label for predict.types and the report"},
       {"data.columns.part", "\"part\"",
        "unique name of each part, so that run-outs can be tracked "
        "([tracking.md](../explanation/tracking.md))"},
       needed_key("law.mean_stress", "\"goodman\"",
                  "mean-stress correction ([fatigue.md](fatigue.md))"),
       {"law.fatigue_limit", "\"random\"", "none or random fatigue limit (none)"},
       {"law.curve", "\"knee\"", "basquin, knee, stromeyer, bastenaire or strain-life (basquin)"},
       {"law.second_slope", "\"free\"", "below a knee: free, haibach (2k - 1) or infinite (free)"},
       {"law.scatter", "\"grows\"", "constant scatter, or scatter that grows with life (constant)"},
       {"law.limit_family", "\"normal\"", "distribution of the logarithm of the limit (normal)"},
       {"likelihood.family", "\"log10-normal\"", "distribution of lives (log10-normal)"}});
  add_keys(keys, parameter_keys());
  add_keys(keys, {{"predict.types", "\"all\"", "the stresses of these labels, or of all tests"}});
  add_keys(keys, point_keys());
  add_keys(keys,
           {{"predict.damage_sum", "\"1 x/ 1.34\"",
             "Miner's sum at which parts on line fail: median, and factor within which two thirds "
             "lie; default 1"},
            {"predict.b_lives", "[1, 10]",
             "percentages failed; adds the lives at which 1 and 10 % have failed"},
            {"predict.mean_life", "true", "adds the mean life (MTTF), without a random limit"},
            {"predict.survival_to", "\"5e5 cycles\"", "adds the share that outlasts this life"},
            needed_key("predict.required_life", "\"1e6 cycles\"",
                       "adds the allowable alternating stress for this life,", {},
                       {"predict.reliability"}),
            needed_key("predict.reliability", "[\"50 %\", \"90 %\"]", "survived by this share", {},
                       {"predict.required_life"}),
            {"predict.stress_ratio", "0.1", "stress ratio of that stress"},
            {"predict.mean_stress", "\"300 MPa\"",
             "mean stress of that stress, instead of stress_ratio"}});
  add_keys(keys, level_keys("B-lives, survival and allowable stresses"));
  return keys;
}

StudyKeys staircase_keys() {
  StudyKeys keys = posterior_keys();
  add_keys(keys, status_keys());
  add_keys(
      keys,
      {needed_key("data.columns.alternating_stress",
                  "{ column = \"alternating_stress\", unit = \"MPa\" }", "stress of the test"),
       needed_key("data.columns.status", "\"status\"", "failure or runout"),
       {"data.columns.count", "\"count\"", "number of equal tests in a row"},
       {"law.limit_family", "\"normal\"", "distribution of the logarithm of the limit (normal)"},
       {"prior.log10_limit", "{ distribution = \"normal\", mean = \"2.5 log10(MPa)\", sd = 0.2 }",
        "logarithm of the median fatigue limit"},
       {"prior.sigma_limit", "{ distribution = \"half-normal\", scale = 0.05 }",
        "scatter of the logarithm of the limit"},
       {"predict.reliability", "[\"50 %\", \"90 %\"]",
        "adds the stress that this share survives"}});
  add_keys(keys, level_keys("the limits"));
  return keys;
}

}  // namespace wearwell::fatigue
