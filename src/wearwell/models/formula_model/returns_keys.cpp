#include "wearwell/models/formula_model/returns_keys.h"

namespace wearwell::formula_model {
namespace {

StudyKeys delay_keys() {
  const std::string table = "data.returns.*";
  StudyKeys keys = {
      {table + ".distribution", "\"lognormal\"",
       "of the delay `*`, `delay_to_use` or `delay_of_report`: lognormal, gamma, weibull, "
       "exponential, loglogistic, inverse-gaussian, birnbaum-saunders, uniform, with the "
       "parameters "
       "of [priors.md](priors.md)"},
      {table + ".median", "\"1 month\"", "of a lognormal delay"},
      {table + ".log_sd", "0.6", "standard deviation of its natural logarithm"},
      {table + ".mean", "\"1 month\"", "of a lognormal, exponential, inverse-gaussian delay"},
      {table + ".sd", "\"1 month\"", "of a lognormal delay"},
      {table + ".scale", "\"1 month\"",
       "of a gamma, weibull, loglogistic, birnbaum-saunders delay"},
      {table + ".shape", "2", "likewise"},
      {table + ".lower", "\"0 month\"", "shortest delay"},
      {table + ".upper", "\"6 month\"", "longest delay"},
      {table + ".unit", "\"month\"", "unit of the distribution"},
      {table + ".file", "\"delays.csv\"",
       "instead of a distribution: a table of delays and the shares of units that have them"},
      {table + ".sql", "\"select * from data\"", "one SELECT over the view `data`"},
      {table + ".delay", "\"months\"", "heading of the delays, or `{ column, unit }`"},
      {table + ".delay.column", "\"months\"", "heading of the delays"},
      {table + ".delay.unit", "\"month\"", "their unit, if the heading has none"},
      {table + ".share", "\"share\"", "heading of the shares, which add up to 1"},
      {table + ".share.column", "\"share\"", "heading of the shares"},
      {table + ".share.unit", "\"1\"", "their unit"}};
  add_keys(keys, layout_keys(table));
  return keys;
}

}  // namespace

StudyKeys returns_keys() {
  StudyKeys keys = {
      {"data.returns", "{ sold = \"month\", quantity = \"shipped\" }",
       "the table is a returns triangle (Nevada table): a row for each month of sale, a column for "
       "each month of return ([warranty.md](warranty.md)); replaces `data.columns`"},
      {"data.returns.sold", "\"sold\"",
       "heading of the month of sale, or of the number of the period; recognized where it is "
       "clear"},
      {"data.returns.quantity", "\"shipped\"", "heading of the number of units sold"},
      {"data.returns.returned", "\"failure date\"",
       "the table has a row for each unit instead: heading of its month or day of return, empty if "
       "it did not come back; `quantity` then says how many units a row stands for (1)"},
      {"data.returns.mode", "\"failure mode\"",
       "heading of the failure mode of the returns, with `[failure_modes] column = \"mode\"`: each "
       "month of sale has a row for each mode; or that of a unit, with `returned`"},
      {"data.returns.until", "\"2025-12\"",
       "with `returned`: the last month that the table covers"},
      {"data.returns.period", "\"month\"",
       "length of a period, if the periods are numbers: `month`, `week`"},
      {"data.returns.ages", "\"middle\"",
       "where in its month of sale the age of a unit begins: `middle` (the default), `start` or "
       "`end`; or `whole`, a return k months after the sale is exactly of age k"},
      {"data.returns.delay_to_use", "\"1 month\"",
       "time from the sale until a unit starts (0); or a table, a distribution of this time: "
       "`{ distribution = \"lognormal\", median = \"1 month\", log_sd = 0.6 }` or `{ file = "
       "\"delays.csv\", delay = \"months\", share = \"share\" }`"},
      {"data.returns.delay_of_report", "\"1 month\"",
       "time from a failure until the table has it (0); or a table, as `delay_to_use`"},
      {"data.returns.warranty", "\"36 month\"",
       "length of the warranty in use; later failures are not claimed (no limit)"},
      {"data.returns.hold_out", "\"2 month\"",
       "last months of the table that are forecast and compared instead of fitted (0)"},
      {"predict.next", "\"12 month\"",
       "with `data.returns`: the returns in this time, by month and by month of sale"},
      {"predict.cost_per_return", "\"180 EUR\"", "cost of one return"},
      {"predict.planned_sales", "{ file = \"planned_sales.csv\" }",
       "sales to come: a table with a month and a number of units"},
      needed_key("predict.planned_sales.file", "\"planned_sales.csv\"", "that table", {},
                 {"predict.planned_sales"}),
      {"predict.planned_sales.sql", "\"select * from data where year = 2026\"",
       "one SELECT over the view `data`"},
      {"predict.planned_sales.sold", "\"month\"", "heading of the month (the first column)"},
      {"predict.planned_sales.quantity", "\"units\"", "heading of the units (the second column)"},
  };
  add_keys(keys, layout_keys("predict.planned_sales"));
  add_keys(keys, delay_keys());
  return keys;
}

}  // namespace wearwell::formula_model
