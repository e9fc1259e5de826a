#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/input/table.h"

namespace wearwell::workbench {

/// Which time a column of dates states.
struct DatesWanted {
  std::string column, layout;  ///< layout: of `strptime`
  std::string since = {};  ///< heading of the dates from which time counts; empty: the first date
  std::string unit = {};   ///< heading: the first date of each of its values; empty: of the table
  std::string until = {};  ///< "2025-12-31": units whose cell is empty were in use until then
};

/// From the page: {"column", "layout", "since", "unit", "until"}. Throws InputError.
DatesWanted read_dates_wanted(const nlohmann::json& wish);

/// The SELECT that replaces a column of dates by the time since other dates, in days, or in hours
/// where a layout has a time of the day. With empty cells it makes a column that says which lives had
/// not ended. `before`: the SELECT that made the table, or empty. Throws InputError that names the
/// cell that is not a date, is empty or is before its beginning.
std::string time_query(const Table& table, const DatesWanted& wanted, const std::string& before);

}  // namespace wearwell::workbench
