#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace wearwell::clutch {

/// The energy of many closings held against what their torque, slip speed and closing time give (closing_energy). A real closing
/// differs by the shapes of torque and slip, and a mixed duty by the product of means: a factor of 2 or 3. A unit of energy that is wrong
/// differs by a thousand, a cycle that cannot be by more.
struct EnergyBalance {
  double measured = 0;  ///< J
  double closings = 0;  ///< J, 1/2 Mz omega0 t2 of the same closings

  double ratio() const { return measured / closings; }
  /// Always true where torque, slip speed or closing time are zero.
  bool is_plausible() const {
    constexpr double most = 5;
    return !(closings > 0) || (ratio() < most && ratio() > 1 / most);
  }
  /// "1000 times 1/2 x torque x slip speed x closing time"
  std::string description() const {
    return fmt::format("{:.3g} times 1/2 x torque x slip speed x closing time", ratio());
  }
};

/// What to do where it does not fit.
inline constexpr const char* energy_advice =
    "Check the unit of the column energy, and look for single cycles with an energy that no "
    "closing "
    "has.";

}  // namespace wearwell::clutch
