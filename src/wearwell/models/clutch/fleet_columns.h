#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"

namespace wearwell::clutch {

/// Columns as the options have them: "unit=VIN", "torque=M:N m" (the unit behind the last colon, or in the
/// column's name: "torque=torque [N m]"); columns that nobody names are searched among `known`, the names
/// of the table, as in files of cycles ("torque [N m]"), where these are known. Without a name the unit is
/// `plate`, and the number of its cycle `cycle`. `time` and `cycles_per_day` are searched nowhere. Throws InputError.
void read_fleet_columns(const std::vector<std::string>& options,
                        const std::vector<fleet::EngineColumn>& known, const std::string& table,
                        SqlSource& source);

/// The column that names units. Throws InputError.
std::string unit_column(const std::vector<std::string>& options);

}  // namespace wearwell::clutch
