#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/models/clutch/cycle_sum.h"

namespace wearwell::clutch {

/// Cycles of a table in memory, as `sum_cycles` reads them from a file: columns plate, cycle,
/// slip_speed, torque, temperature, closing_time and energy with their units. Plates may have
/// names; these become their places among `names`, from 1, to which new ones are appended. Throws
/// InputError naming row and column.
CycleColumns cycle_columns(const Table& table, std::vector<std::string>& names);

/// Plates whose energy does not fit their torque, slip speed and closing time, one sentence each:
/// their wear is not trusted.
std::vector<std::string> energy_problems(const CycleSum& sum);

/// The output of `wearwell clutch predict --json`; `full` if the sum has replicates.
nlohmann::ordered_json wear_json(const WearModel& model, const CycleSum& sum, bool full);

}  // namespace wearwell::clutch
