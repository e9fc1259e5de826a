#include "wearwell/models/joint/joint_keys.h"

#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_keys.h"

namespace wearwell::joint {

StudyKeys study_keys() {
  const std::vector<std::string> positions = {"data.columns.dx", "data.columns.dy"};
  StudyKeys keys = posterior_keys();
  add_keys(
      keys,
      {needed_key("data.columns.cycles", "\"cycles\"", "cycles until each inspection"),
       {"data.joint", "\"J7\"",
        "name of the joint, which its readings carry in the monitor (joint)"},
       {"data.columns.count", "\"count\"", "number of equal rows"},
       needed_key("data.columns.volume", "{ column = \"volume\", unit = \"mm^3\" }", "worn volume",
                  positions),
       {"data.columns.work", "{ column = \"work\", unit = \"kJ\" }",
        "friction work until each inspection, if it varies between cycles"},
       needed_key("data.columns.force", "{ column = \"force\", unit = \"N\" }",
                  "normal force, with slip instead of work", {}, {"data.columns.slip"}),
       needed_key("data.columns.slip", "{ column = \"slip\", unit = \"m\" }",
                  "slip distance until each inspection", {}, {"data.columns.force"}),
       needed_key("data.columns.dx", "{ column = \"dx\", unit = \"mm\" }",
                  "position of the pin, instead of volume: rows are angles", {},
                  {"data.columns.dy"}),
       needed_key("data.columns.dy", "{ column = \"dy\", unit = \"mm\" }",
                  "position of the pin across dx", {}, {"data.columns.dx"}),
       needed_key(
           "conditions.work_per_cycle", "\"5.966 N m\"", "friction work of one cycle",
           {"conditions.profile", "data.columns.work", "data.columns.force", "data.columns.slip"}),
       needed_key("conditions.pin_radius", "\"9.5 mm\"", "for pin positions", {}, positions),
       needed_key("conditions.bushing_radius", "\"9.6 mm\"", "for pin positions", {}, positions),
       needed_key("conditions.length", "\"20 mm\"", "of the bearing surface, for pin positions", {},
                  positions),
       needed_key("conditions.profile.file", "\"cycle.csv\"",
                  "table of force and slip over one cycle", {}, {"conditions.profile"}),
       {"conditions.profile.sql", "\"select * from data\"", "as data.sql, for that table"},
       needed_key("conditions.profile.rule", "\"trapezoid\"",
                  "how the work of the cycle is summed ([joint.md](joint.md))", {},
                  {"conditions.profile"}),
       needed_key("conditions.profile.columns.force", "{ column = \"force\", unit = \"N\" }",
                  "normal force", {}, {"conditions.profile"}),
       needed_key("conditions.profile.columns.slip_increment", "{ column = \"ds\", unit = \"mm\" }",
                  "slip since the previous row", {}, {"conditions.profile"}),
       {"conditions.profile.columns.*.column", "\"force\"", "heading of the column"},
       {"conditions.profile.columns.*.unit", "\"N\"", "unit of its numbers"},
       needed_key("likelihood.family", "\"normal\"", "distribution of one measurement"),
       {"prior.k", "{ distribution = \"flat\", unit = \"mm^3/(N m)\" }", "wear coefficient"},
       {"prior.sigma", "{ distribution = \"uniform\", lower = \"0 mm^3\", upper = \"15 mm^3\" }",
        "scatter of one measurement"},
       {"prior.V0", "{ distribution = \"normal\", mean = \"0 mm^3\", sd = \"10 mm^3\" }",
        "volume before any work: the model becomes V = V0 + k W"},
       {"prior.exponent", "{ distribution = \"normal\", mean = 1, sd = 0.2 }",
        "exponent of the work: the model becomes V = k W (W/W_ref)^(exponent - 1)"},
       {"predict.cycles", "[20000, \"50 kcycles\"]", "adds the worn volume then"},
       {"predict.limit", "\"100 mm^3\"", "failure threshold: adds the life until this volume"},
       {"predict.risk", "\"1 %\"",
        "risk of passing the threshold before the next inspection (1 %)"},
       {"predict.b_lives", "[1, 10]",
        "percentages failed; adds the lives at which 1 and 10 % have reached the threshold"},
       {"predict.work_per_cycle", "\"6 N m\"",
        "of future cycles, if conditions.work_per_cycle is not given"}});
  add_keys(keys, layout_keys("conditions.profile"));
  add_keys(keys, level_keys("B-lives"));
  return keys;
}

}  // namespace wearwell::joint
