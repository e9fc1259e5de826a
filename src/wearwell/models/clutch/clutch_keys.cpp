#include "wearwell/models/clutch/clutch_keys.h"

namespace wearwell::clutch {

StudyKeys study_keys() {
  const std::vector<std::string> simulated = {"simulation"}, measured = {"data"};
  const std::string point = "life.points.*";
  StudyKeys keys = {
      {"title", "\"Dry clutch, lining B\"", "heading of the report"},
      needed_key("model", "\"clutch-wear\"", "the model; `wearwell new` has an example of each"),
      needed_key("data.design", "\"design.csv\"",
                 "points of the campaign (`wearwell clutch design`)", simulated),
      needed_key("data.cycles", "\"cycles.csv\"", "every closing of every plate", simulated),
      needed_key("data.weighings", "\"weighings.csv\"", "weighings of the plates", simulated),
      {"data.traces", "\"traces.csv\"", "speed, torque and temperature over some closings"},
      needed_key("simulation.design", "\"design.csv\"",
                 "instead of [data]: points of a campaign to simulate", {}, simulated),
      needed_key("simulation.truth", "\"truth.toml\"", "true parameters of the simulation", {},
                 simulated),
      {"simulation.seed", "1", "seed of the simulation"},
      needed_key("lining.density", "\"2.2 g/cm^3\"", "of the lining", simulated, measured),
      needed_key("lining.depth", "\"1 mm\"", "depth at which the lining is worn out", simulated,
                 measured),
      needed_key("lining.area", "\"100 cm^2\"", "of the lining", simulated, measured),
      needed_key("balance.sd", "\"1 mg\"", "standard deviation of one weighing", simulated,
                 measured),
      {"search.lowest", "0.1", "smallest exponent r and q of the grid"},
      {"search.highest", "3.0", "largest"},
      {"search.step", "0.1", "step of the grid"},
      {"uncertainty.replicates", "50", "simulated repetitions of the whole fit; 0 for none"},
      {"uncertainty.seed", "1", "seed of these repetitions"},
      {"life.levels", "[0.5, 1]", "wear levels, as shares of the worn-out volume"},
      {point, "{ slip_speed = \"1700 rpm\", ... }",
       "a duty with a name of your choice: adds its life"},
      needed_key(point + ".slip_speed", "\"1700 rpm\"", "slip speed at the start of closing"),
      needed_key(point + ".torque", "\"50 N m\"", "mean torque while it slips"),
      needed_key(point + ".temperature", "\"170 degC\"", "temperature of the lining"),
      needed_key(point + ".closing_time", "\"2.15 s\"", "time until it sticks"),
      {"data.missing_cycles", "\"fill\"",
       "gaps in the log: refuse, or fill each missing closing with a copy of the previous one"},
  };
  add_keys(keys, layout_keys());
  for (const std::string name : {"design", "cycles", "weighings", "traces"}) {
    const std::string table = "data." + name;
    add_keys(keys,
             {{table + ".file", "\"" + name + ".csv\"", "the table, if it needs further keys"},
              {table + ".sql", "\"select * from data\"", "query whose rows replace the table"},
              {table + ".columns.*", "\"heading\"", "headings of the columns, by the names here"}});
    add_keys(keys, layout_keys(table));
    add_keys(keys, column_keys(table));
  }
  return keys;
}

}  // namespace wearwell::clutch
