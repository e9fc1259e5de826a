#include "wearwell/study/posterior_keys.h"

namespace wearwell {

StudyKeys posterior_keys() {
  StudyKeys keys = {
      {"title", "\"Pin joint of a press\"", "heading of the report"},
      needed_key("model", "\"archard-joint\"",
                 "the model; `wearwell new` writes an example of each"),
      needed_key("data.file", "\"wear.csv\"",
                 "table of the data, beside the study ([tables.md](tables.md))"),
      {"data.sql", "\"select * from data where cycles < 1e5\"",
       "one SELECT over the view `data`; its rows replace those of the table"},
  };
  add_keys(keys, layout_keys());
  add_keys(keys, column_keys());
  add_keys(keys, prior_keys());
  add_keys(
      keys,
      {{"update.stages", "\"row\"",
        "also compute the posterior after 1, 2, ... rows; not for model sn"},
       {"sampler.method", "\"nuts\"", "sampling method; --method overrides it"},
       {"sampler.chains", "4", "independent chains"},
       {"sampler.warmup", "1000", "iterations discarded per chain"},
       {"sampler.draws", "1000", "draws kept per chain"},
       {"sampler.seed", "1", "seed of the random numbers; the same seed gives identical results"},
       {"sampler.max_treedepth", "10", "of NUTS: at most 2^max_treedepth steps per draw"},
       {"sampler.metric", "\"dense\"", "of NUTS: the mass matrix"},
       {"sampler.target_accept", "0.8", "of NUTS: between 0 and 1; larger is slower and safer"},
       {"sampler.half_width.*", "\"1e-5 mm^3/(N m)\"",
        "of Metropolis: half-width of its uniform proposals, for each unknown; by default it "
        "adapts its steps"}});
  return keys;
}

}  // namespace wearwell
