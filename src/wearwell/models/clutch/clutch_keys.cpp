#include "wearwell/models/clutch/clutch_keys.h"

namespace wearwell::clutch {

StudyKeys study_keys() {
  const std::vector<std::string> simulated = {"simulation"}, measured = {"data"};
  const std::string point = "life.points.*";
  StudyKeys keys = {
      {"title", "\"Dry clutch, lining B\"", "heading of the report"},
      needed_key("model", "\"clutch-wear\"", "the law; `wearwell new` has an example of each"),
      needed_key("data.design", "\"design.csv\"",
                 "points of the campaign (`wearwell clutch design`)", simulated),
      needed_key("data.cycles", "\"cycles.csv\"", "every closing of every plate", simulated),
      needed_key("data.weighings", "\"weighings.csv\"", "weighings of the plates", simulated),
      {"data.traces", "\"traces.csv\"", "speed, torque and temperature over some closings"},
      needed_key("simulation.design", "\"design.csv\"",
                 "instead of [data]: points of a campaign to simulate", {}, simulated),
      needed_key("simulation.truth", "\"truth.toml\"", "what is true in the simulation", {},
                 simulated),
      {"simulation.seed", "1", "seed of the simulation"},
      needed_key("lining.density", "\"2.2 g/cm^3\"", "of the lining", simulated, measured),
      needed_key("lining.depth", "\"1 mm\"", "at which the lining is worn out", simulated,
                 measured),
      needed_key("lining.area", "\"100 cm^2\"", "of the lining", simulated, measured),
      needed_key("balance.sd", "\"1 mg\"", "standard deviation of one weighing", simulated,
                 measured),
      {"search.lowest", "0.1", "smallest exponent r and q that is tried"},
      {"search.highest", "3.0", "largest"},
      {"search.step", "0.1", "and in such steps"},
      {"uncertainty.replicates", "50", "simulated repetitions of the whole fit; 0 for none"},
      {"uncertainty.seed", "1", "seed of these"},
      {"life.levels", "[0.5, 1]", "wear levels, of the worn-out volume"},
      {point, "{ slip_speed = \"1700 rpm\", ... }",
       "a duty by a name of yours: how long is its life?"},
      needed_key(point + ".slip_speed", "\"1700 rpm\"", "when it closes"),
      needed_key(point + ".torque", "\"50 N m\"", "while it slips"),
      needed_key(point + ".temperature", "\"170 degC\"", "of the lining"),
      needed_key(point + ".closing_time", "\"2.15 s\"", "until it sticks"),
      {"data.missing_cycles", "\"fill\"",
       "where a logger lost closings: refuse, or fill each with a copy of the one before"},
  };
  add_keys(keys, layout_keys());
  for (const std::string name : {"design", "cycles", "weighings", "traces"}) {
    const std::string table = "data." + name;
    add_keys(
        keys,
        {{table + ".file", "\"" + name + ".csv\"", "the table, where more is to be said of it"},
         {table + ".sql", "\"select * from data\"", "its rows are taken instead"},
         {table + ".columns.*", "\"heading\"", "which column is what, by its name here"}});
    add_keys(keys, layout_keys(table));
    add_keys(keys, column_keys(table));
  }
  return keys;
}

}  // namespace wearwell::clutch
