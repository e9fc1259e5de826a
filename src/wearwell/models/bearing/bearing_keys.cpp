#include "wearwell/models/bearing/bearing_keys.h"

#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_keys.h"

namespace wearwell::bearing {
namespace {

// An input of every inspection: a column, or one value for all.
StudyKeys input_keys(const std::string& name, const std::string& column,
                     const std::string& constant, const std::string& meaning,
                     std::vector<std::string> unless = {}, std::vector<std::string> when = {}) {
  unless.push_back("conditions." + name);
  return {needed_key("data.columns." + name, column, meaning, unless, when),
          {"conditions." + name, constant, meaning + ", the same for all rows"}};
}

}  // namespace

StudyKeys study_keys() {
  const std::vector<std::string> load = {"data.columns.force", "conditions.force",
                                         "data.columns.length", "conditions.length"};
  const std::vector<std::string> turning = {"data.columns.speed", "conditions.speed",
                                            "data.columns.time", "conditions.time"};
  StudyKeys keys = posterior_keys();
  add_keys(keys, {needed_key("data.columns.depth", "{ column = \"depth\", unit = \"um\" }",
                             "wear depth of each inspection"),
                  {"data.columns.count", "\"count\"", "number of equal rows"},
                  {"data.columns.bearing", "\"bearing\"",
                   "the bearing of a row; without it each row is its own bearing"}});
  add_keys(keys, input_keys("radius", "{ column = \"radius\", unit = \"mm\" }", "\"10 mm\"",
                            "radius of the journal"));
  add_keys(keys, input_keys("clearance", "{ column = \"clearance\", unit = \"um\" }", "\"25 um\"",
                            "radial clearance"));
  add_keys(keys, input_keys("contact", "\"contact\"", "\"stationary\"",
                            "stationary (a scar in the bushing), journal or bushing (even wear)"));
  add_keys(keys, input_keys("pressure", "{ column = \"pressure\", unit = \"MPa\" }", "\"1.5 MPa\"",
                            "pressure on the projected area", load));
  add_keys(keys, input_keys("force", "{ column = \"force\", unit = \"N\" }", "\"400 N\"",
                            "load, with length instead of pressure", {},
                            {"data.columns.length", "conditions.length"}));
  add_keys(keys, input_keys("length", "{ column = \"length\", unit = \"mm\" }", "\"20 mm\"",
                            "length of the bearing, with force", {},
                            {"data.columns.force", "conditions.force"}));
  add_keys(keys, input_keys("revolutions", "\"revolutions\"", "\"100 krev\"",
                            "revolutions until the inspection", turning));
  add_keys(keys, input_keys("speed", "{ column = \"speed\", unit = \"rpm\" }", "\"60 rpm\"",
                            "speed, with time instead of revolutions", {},
                            {"data.columns.time", "conditions.time"}));
  add_keys(keys, input_keys("time", "{ column = \"time\", unit = \"h\" }", "\"200 h\"",
                            "time until the inspection, with speed", {},
                            {"data.columns.speed", "conditions.speed"}));
  add_keys(
      keys,
      {{"likelihood.family", "\"normal\"", "how one measured depth scatters (normal)"},
       {"likelihood.depth_error", "\"2 um\"",
        "known standard deviation of one measured depth, instead of the prior of sigma"},
       {"prior.k", "{ distribution = \"lognormal\", median = \"1e-6 mm^3/(N m)\", log_sd = 2.5 }",
        "specific wear rate"},
       {"prior.sigma", "{ distribution = \"half-normal\", scale = \"5 um\" }",
        "scatter of one measured depth"},
       {"prior.k_scatter", "{ distribution = \"half-normal\", scale = 1 }",
        "scatter of ln k between bearings: gives each bearing its own rate"},
       {"predict.revolutions", "[100000, \"400 krev\"]", "adds the depth then"},
       {"predict.time", "[\"500 h\"]", "adds the depth then; needs a speed"},
       {"predict.limit", "\"80 um\"", "failure threshold: adds the life until this depth"},
       {"predict.life_of", "\"b3\"",
        "a bearing of the data: its remaining useful life instead of the life of a new one"},
       {"predict.risk", "0.01",
        "risk of reaching the threshold; adds the inspection time of a new bearing"},
       {"predict.b_lives", "[1, 10]",
        "percentages failed; adds the lives at which 1 and 10 % have reached the threshold"},
       {"predict.mean_life", "true", "adds the mean life (MTTF) to the threshold"},
       {"predict.required_revolutions", "\"1 Mrev\"",
        "adds the pressure at which the threshold is reached after this use"},
       {"predict.required_time", "\"200 h\"", "the same, at a speed"},
       {"predict.force", "\"500 N\"",
        "adds the required length; or, with length, gives the pressure"},
       {"predict.length", "\"20 mm\"", "with force: the pressure"},
       {"predict.contact", "\"stationary\"",
        "geometry of the predicted bearing, as the next five keys; the default is [conditions]"},
       {"predict.radius", "\"10 mm\"", "radius of the journal"},
       {"predict.clearance", "\"30 um\"", "radial clearance"},
       {"predict.pressure", "\"1.5 MPa\"", "pressure on the projected area"},
       {"predict.speed", "\"60 rpm\"", "speed, for lives in hours"}});
  add_keys(keys, level_keys("B-lives"));
  return keys;
}

}  // namespace wearwell::bearing
