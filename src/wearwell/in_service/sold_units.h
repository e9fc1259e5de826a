#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/fleet/engine.h"
#include "wearwell/present/table.h"

namespace wearwell::in_service {

/// Columns of a table with a row for each unit that was sold: the date of sale and of return (null: it did not come back).
struct SoldColumns {
  std::string sold, returned;
  std::string quantity = {};  ///< how many units a row stands for; empty: one
  std::string mode = {};      ///< of failure; empty: the table has none
};
/// From --columns; throws InputError.
SoldColumns read_sold_columns(const std::vector<std::string>& options);

/// Units by month of sale and of return; months as numbers since January of year 0.
struct SoldUnits {
  struct Returns {
    std::map<std::pair<int, int>, double> units;  ///< by months of sale and of return
  };
  std::map<int, double> sold;
  std::map<std::string, Returns>
      returned;  ///< by failure mode; one without a name if there are none
  double late_sales = 0, late_returns = 0;  ///< after the last month; these returns are not counted
};

/// Adds the units of an engine's table until the month `until`. The engine counts; months are those of dates, and of
/// timestamps in UTC. Throws InputError for a column that holds no dates, and for units without a date of sale, with a
/// return before it, a quantity that is not a whole number, or a mode without a return.
void count_sold_units(fleet::Engine& engine, const SoldColumns& columns, int until,
                      SoldUnits& units);

/// The returns triangle (Nevada table) that [data.returns] reads: sold, mode if any, units, and a column for each month
/// from the first sale to `until`. Throws InputError if no unit was sold until then.
present::Table returns_table(const SoldUnits& units, bool with_modes, int until);

}  // namespace wearwell::in_service
