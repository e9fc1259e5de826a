#include "wearwell/models/recurrence/recurrence_keys.h"

#include "wearwell/study/life_levels.h"
#include "wearwell/study/posterior_keys.h"

namespace wearwell::recurrence {

StudyKeys study_keys() {
  StudyKeys keys = posterior_keys();
  add_keys(keys,
           {needed_key("process", "\"power_law\"",
                       "power_law (minimal repair, as bad as old), renewal (as good as new) or "
                       "phases (of a growth test)"),
            needed_key("data.columns.unit", "\"engine\"", "unit of the event"),
            needed_key("data.columns.age", "{ column = \"age\", unit = \"day\" }",
                       "age of the unit at the event: time, distance or cycles"),
            {"data.columns.event", "\"event\"",
             "failure, or end of observation; needed unless `data.grouped`"},
            {"data.columns.event.failure", "\"repaired\"",
             "your word for a failure, or its code 1 or 0"},
            {"data.columns.event.end", "\"retired\"", "your word for the end of observation"},
            {"data.columns.count", "\"count\"",
             "number of failures of the unit at that age, if a row is several; needs "
             "`data.rounding` or `data.grouped`; 1, 0 or empty at an end of observation"},
            {"data.grouped", "true",
             "`count` is the number of failures since the row before of the unit, at unknown ages "
             "(false)"},
            {"data.unused", "[\"count\"]",
             "headings of columns that look like a number of failures but are not"},
            {"data.columns.start", "{ column = \"start\", unit = \"day\" }",
             "age at which observation of the unit began (0)"},
            {"data.columns.mode", "\"mode\"",
             "failure mode of each failure of a growth test; needs `fixes`"},
            {"fixes.none", "[\"A\"]", "modes that are not fixed (A)"},
            {"fixes.during", "[\"BC1\"]", "modes that were fixed during the test (BC)"},
            {"fixes.effectiveness.*", "0.7",
             "of a mode that is fixed after the test (BD): the share of its failure intensity that "
             "the fix removes, a number from 0 to 1 or a distribution"},
            {"fixes.effectiveness.*.distribution", "\"beta\"", "as in `[prior]`"},
            {"fixes.effectiveness.*.*", "7", "parameter or bound, as in `[prior]`"},
            {"data.end", "\"last failure\"",
             "units without a row of their end were observed until their last failure (row)"},
            {"data.rounding", "\"1 day\"",
             "step to which ages are rounded; needed for two failures at one age"},
            {"conditions.reference_age", "\"600 day\"",
             "age T of M_T; by default the largest age at an end of observation"},
            {"conditions.phase_ends", "[\"500 h\", \"1000 h\"]",
             "of phases: the ages at which all phases but the last end"},
            {"prior.*", "{ distribution = \"lognormal\", median = \"100 h\", log_sd = 1 }",
             "of phases: MTBF_1, MTBF_2, ..., the mean time between failures in each phase"},
            {"prior.beta", "{ distribution = \"lognormal\", median = 1, log_sd = 0.7 }",
             "shape: above 1 failures become more frequent with age (power law) or with the time "
             "since a repair (renewal)"},
            {"prior.M_T", "{ distribution = \"lognormal\", median = 1, log_sd = 3 }",
             "of a power law: expected failures of one unit until the age T"},
            {"prior.eta", "{ distribution = \"lognormal\", median = \"500 day\", log_sd = 1 }",
             "of renewals: characteristic life between failures"},
            {"predict.age", "[\"600 day\"]",
             "of a power law: adds MTBF and time to the next failure at this age (that of the "
             "oldest unit)"},
            {"predict.next", "[\"100 day\"]",
             "adds the number of failures in this time, of all units and of each"},
            {"predict.classical", "true",
             "maximum likelihood with Fisher, likelihood-ratio and exact bounds (chi-square, Crow) "
             "beside the posterior"}});
  add_keys(keys, level_keys("mean times between failures, times to the next failure, failures to "
                            "come and the mean cumulative function, and of predict.classical"));
  return keys;
}

}  // namespace wearwell::recurrence
