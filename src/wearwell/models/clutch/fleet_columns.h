#pragma once

#include <string>
#include <vector>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/clutch_sql.h"

namespace wearwell::clutch {

/// Columns from the options: "unit=VIN", "torque=M:N m" (the unit after the last colon, or in the
/// column's name: "torque=torque [N m]"); columns without an option are looked up in `known`, the
/// names of the table, as in files of cycles ("torque [N m]"), if these are known. By default the
/// unit is `plate`, and the number of its cycle `cycle`. `time` and `cycles_per_day` are never
/// looked up. Throws InputError.
void read_fleet_columns(const std::vector<std::string>& options,
                        const std::vector<fleet::EngineColumn>& known, const std::string& table,
                        SqlSource& source);

/// The column that names units. Throws InputError.
std::string unit_column(const std::vector<std::string>& options);

}  // namespace wearwell::clutch
