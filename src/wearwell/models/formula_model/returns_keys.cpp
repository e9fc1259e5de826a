#include "wearwell/models/formula_model/returns_keys.h"

namespace wearwell::formula_model {

StudyKeys returns_keys() {
  StudyKeys keys = {
      {"data.returns", "{ sold = \"month\", quantity = \"shipped\" }",
       "the table is a returns triangle (Nevada table): a row for each month of sale, a column for "
       "each month of return ([warranty.md](warranty.md)); replaces `data.columns`"},
      {"data.returns.sold", "\"sold\"",
       "heading of the month of sale, or of the number of the period; recognized where it is "
       "clear"},
      {"data.returns.quantity", "\"shipped\"", "heading of the number of units sold"},
      {"data.returns.period", "\"month\"",
       "length of a period, if the periods are numbers: `month`, `week`"},
      {"data.returns.ages", "\"middle\"",
       "where in its month of sale the age of a unit begins: `middle` (the default), `start` or "
       "`end`; or `whole`, a return k months after the sale is exactly of age k"},
      {"data.returns.delay_to_use", "\"1 month\"", "time from the sale until a unit starts (0)"},
      {"data.returns.delay_of_report", "\"1 month\"",
       "time from a failure until the table has it (0)"},
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
  return keys;
}

}  // namespace wearwell::formula_model
