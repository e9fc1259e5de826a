#pragma once

#include <array>
#include <numbers>
#include <string>
#include <vector>

namespace wearwell::clutch {

/// One revolution per minute, in rad/s.
inline constexpr double rpm = std::numbers::pi / 30;

/// Conditions of one closing of the clutch, or their mean over many (Haramina et al. 2025, section
/// 2). SI except for the temperature: submodels of a polynomial depend on the origin of an input,
/// and the paper uses the Celsius scale.
struct OperatingPoint {
  double slip_speed = 0;    ///< omega0, at the start of closing, rad/s
  double torque = 0;        ///< M_z, mean over the closing, N m
  double temperature = 0;   ///< T_d, of the disc, degrees Celsius
  double closing_time = 0;  ///< t2, until the slip ends, s
};

/// Friction energy of one closing, J, for a slip speed that falls linearly under a constant torque.
inline double closing_energy(const OperatingPoint& at) {
  return 0.5 * at.torque * at.slip_speed * at.closing_time;
}

/// The four numbers of an operating point, in the order of the files: name, unit in SI (Celsius for
/// the temperature), and position.
struct Input {
  const char* name;
  const char* symbol;
  const char* si;  ///< dimension
  double OperatingPoint::*value;
};
inline constexpr std::array<Input, 4> inputs = {
    Input{"slip_speed", "omega0", "rad/s", &OperatingPoint::slip_speed},
    Input{"torque", "Mz", "N m", &OperatingPoint::torque},
    Input{"temperature", "Td", "K", &OperatingPoint::temperature},
    Input{"closing_time", "t2", "s", &OperatingPoint::closing_time}};

/// The purpose of an operating point of a campaign.
enum class Role {
  model,          ///< of the full factorial
  extrapolation,  ///< outside the factorial's ranges, to fit
  validation      ///< inside, held out
};

struct DesignPoint {
  int number = 0;  ///< from 1
  Role role = Role::model;
  OperatingPoint at;
};

const char* name_of(Role role);
/// Throws InputError for another name.
Role read_role(const std::string& name);

}  // namespace wearwell::clutch
