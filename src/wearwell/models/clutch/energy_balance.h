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

/// Cycles of which each has more than `most` times the energy of its closing: one such among millions changes their sum, and no balance
/// of all shows it.
struct EnergyOutliers {
  static constexpr double most = 10;
  long long count = 0;
  long long worst_cycle = 0;  ///< the number of the farthest off
  double worst_energy = 0;    ///< J
  double worst_ratio = 0;     ///< to 1/2 Mz omega0 t2

  void look_at(long long cycle, double energy, double closing) {
    const double ratio = energy / closing;
    if (!(closing > 0) || !(ratio > most)) return;
    ++count;
    if (!(ratio > worst_ratio)) return;
    worst_cycle = cycle;
    worst_energy = energy;
    worst_ratio = ratio;
  }
};

/// The same of units that have names.
struct FleetOutliers {
  EnergyOutliers all;
  std::string unit;  ///< of the farthest off

  void look_at(const std::string& name, long long cycle, double energy, double closing) {
    const double before = all.worst_ratio;
    all.look_at(cycle, energy, closing);
    if (all.worst_ratio > before) unit = name;
  }
  void add(const FleetOutliers& other) {
    const long long count = all.count + other.all.count;
    if (other.all.worst_ratio > all.worst_ratio) *this = other;
    all.count = count;
  }
};

/// What to do where it does not fit.
inline constexpr const char* energy_advice =
    "Check the unit of the column energy, and look for single cycles with an energy that no "
    "closing "
    "has.";

}  // namespace wearwell::clutch
