#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "wearwell/input/labelled.h"
#include "wearwell/models/clutch/campaign.h"
#include "wearwell/models/clutch/closing.h"
#include "wearwell/models/clutch/tribometer.h"

/// Files of a campaign. Headings carry units, "torque [N m]" (table/labelled.h); any unit of the
/// right dimension will do. All readers throw InputError naming file, row, column and value.
namespace wearwell::clutch {

/// point, role, slip_speed, torque, temperature, closing_time.
std::vector<DesignPoint> read_design(const std::filesystem::path& file);
/// plate, cycle, slip_speed, torque, temperature, closing_time, energy.
std::vector<Cycle> read_cycles(const std::filesystem::path& file);
/// plate, cycle, mass, block ("start", "run-in", "point 17", "run-out", "sequence NAME").
std::vector<Weighing> read_weighings(const std::filesystem::path& file);
/// plate, time, slip_speed, torque, temperature.
std::vector<Sample> read_traces(const std::filesystem::path& file);

std::string design_csv(const std::vector<DesignPoint>& design);
std::string cycles_csv(const std::vector<Cycle>& cycles);
std::string weighings_csv(const std::vector<Weighing>& weighings);
std::string traces_csv(const std::vector<Sample>& samples);
std::string closings_csv(const std::vector<Closing>& closings);
std::string realized_csv(const std::vector<Realized>& realized);

/// 0 degC in K: tables are read in SI, OperatingPoint holds degrees Celsius.
inline constexpr double celsius_zero = 273.15;

/// One mm^3 in m^3.
inline constexpr double mm3 = 1e-9;

}  // namespace wearwell::clutch
