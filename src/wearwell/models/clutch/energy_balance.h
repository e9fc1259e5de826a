#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace wearwell::clutch {

/// The energy of many closings compared with that from their torque, slip speed and closing time
/// (closing_energy). A real closing differs by the shapes of torque and slip, and a mixed duty by
/// the product of means: a factor of 2 or 3. A wrong unit of energy differs by a thousand, an
/// impossible cycle by more.
struct EnergyBalance {
  double measured = 0;  ///< J
  double closings = 0;  ///< J, 1/2 Mz omega0 t2 of the same closings

  double ratio() const { return measured / closings; }
  /// Always true if torque, slip speed or closing time are zero.
  bool is_plausible() const {
    constexpr double most = 5;
    return !(closings > 0) || (ratio() < most && ratio() > 1 / most);
  }
  /// "1000 times 1/2 x torque x slip speed x closing time"
  std::string description() const {
    return fmt::format("{:.3g} times 1/2 x torque x slip speed x closing time", ratio());
  }
};

/// Cycles with more than `most` times the energy of their closing: one of them among millions
/// changes the sum without changing the overall balance.
struct EnergyOutliers {
  static constexpr double most = 10;
  long long count = 0;
  long long worst_cycle = 0;  ///< number of the largest
  double worst_energy = 0;    ///< J
  double worst_ratio = 0;     ///< relative to 1/2 Mz omega0 t2

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

/// The same for units with names.
struct FleetOutliers {
  EnergyOutliers all;
  std::string unit;  ///< of the largest

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

/// Advice if it does not fit.
inline constexpr const char* energy_advice =
    "Check the unit of the column energy, and look for single cycles with an energy that no "
    "closing can have.";

}  // namespace wearwell::clutch
