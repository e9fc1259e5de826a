#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/fleet/engine.h"

namespace wearwell::fleet {

/// The columns that options name, "unit=VIN", "torque=M:N m": by name, as given. Throws InputError
/// for a name that is none of `names`, or occurs twice, and for one without a column.
std::map<std::string, std::string> split_columns(const std::vector<std::string>& options,
                                                 const std::vector<std::string>& names);

/// A column of numbers with its unit.
struct UnitColumn {
  std::string column;
  Unit unit;
  bool unit_by_option = false;  ///< in place of the column's heading
};

/// "M:N m" (the unit after the last colon) or "torque [N m]" of the option `name`; `si` is the
/// dimension. Throws InputError.
UnitColumn column_with_unit(const std::string& name, const std::string& text,
                            const std::string& si);

/// The unit that an example proposes: temperatures in kelvin are rare.
std::string_view usual_unit(std::string_view si);

/// Throws InputError, with the nearest name, if the table `source` has no such column, or not one of
/// numbers where these are needed. `known` may be empty: then nothing is known of the table.
void require_column(const std::vector<EngineColumn>& known, const std::string& column,
                    const std::string& source, bool is_number);

/// A column as an expression: of a table that is read as text, with the decimal mark
/// `text_decimal`, numbers or null; 0: the column itself. `name` is quoted for the dialect.
std::string number_cell(const std::string& name, char text_decimal);

}  // namespace wearwell::fleet
