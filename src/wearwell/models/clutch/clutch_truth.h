#pragma once

#include <filesystem>
#include <string>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/clutch/tribometer.h"

namespace wearwell::clutch {

/// The truth of a simulated campaign, from TOML (examples/clutch/truth.toml). Throws InputError.
Truth read_truth(const std::filesystem::path& file);

/// Keys slip_speed, torque, temperature, closing_time of a table.
OperatingPoint read_operating_point(const TomlReader& table);
/// A temperature in degrees Celsius.
double read_celsius(const TomlReader& table, const char* key);
/// lining.{density, depth, area} and balance.sd: into density, worn_out, balance_sd.
struct Lining {
  double density = 0;     ///< kg/m^3
  double worn_out = 0;    ///< depth times area, m^3
  double balance_sd = 0;  ///< kg
};
Lining read_lining(const TomlReader& root);

}  // namespace wearwell::clutch
