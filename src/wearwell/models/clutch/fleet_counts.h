#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "wearwell/models/clutch/unit_forecast.h"

namespace wearwell::clutch {

/// A number of units with an interval of at least 95 %, which contains it.
struct UnitCount {
  double expected = 0, low = 0, high = 0;
};

/// A unit in the report. Volumes m^3, cycles from now on.
struct UnitRow {
  std::string unit;
  double cycles = 0, energy = 0, volume = 0, sd = 0, full_sd = 0;
  double left = 0;  ///< until it is worn out
  LifeInterval scatter = {}, full = {};
  double reached = 0;  ///< probability that it is worn out already
  double outside_any = 0, negative = 0;
  double per_day = std::numeric_limits<double>::quiet_NaN();  ///< cycles; NaN if unknown
};

/// All units together, added one after the other. The uncertainty of the model is common to all of
/// them: given replicate b, a certain number of units is expected beyond a level, with scatter only
/// from the units' own variation. So an interval of the fleet is that of a mixture of normal
/// distributions, one per replicate; it does not shrink with the number of units.
class FleetCounts {
 public:
  /// `levels`: shares of the worn-out volume; `horizons`: cycles from now on, including 0; `days`:
  /// further horizons in days, with each unit's own cycles per day.
  FleetCounts(const WearModel& model, bool replicates, std::vector<double> levels,
              std::vector<double> horizons, std::vector<double> days = {});

  /// `per_day`: cycles per day of each unit; empty if there are no days. The same for any number of
  /// threads. Throws InputError for sums that are not finite.
  std::vector<UnitRow> add(std::span<const UnitSums> units, std::span<const double> per_day,
                           int threads);
  UnitRow add(const UnitSums& sums) { return add({&sums, 1}, {}, 1).front(); }

  const std::vector<double>& levels() const { return levels_; }
  const std::vector<double>& horizons() const { return horizons_; }
  const std::vector<double>& days() const { return days_; }
  std::size_t units() const { return units_; }
  /// Units that have reached the level after that horizon; horizons in days follow those in cycles.
  /// The interval has the quantiles of 2.5 and 97.5 % of the mixture, widened to the model's own
  /// count if that lies outside.
  UnitCount reached(std::size_t level, std::size_t horizon) const;

  /// Means over the cycles of each unit, for quantiles over units: slip speed, torque, temperature, closing
  /// time, energy of a cycle.
  static constexpr std::size_t duties = 5;
  const std::array<std::vector<float>, duties>& duty() const { return duty_; }
  const std::vector<float>& worn() const { return worn_; }  ///< share of the worn-out volume
  double cycles() const { return cycles_; }
  double energy() const { return static_cast<double>(energy_) * energy_unit; }
  const std::array<double, 4>& outside() const { return outside_; }
  double outside_any() const { return outside_any_; }
  double negative() const { return negative_; }
  std::size_t units_outside() const { return units_outside_; }

  /// Units whose energy does not fit their torque, slip speed and closing time (EnergyBalance).
  struct Implausible {
    std::size_t units = 0;
    double volume = 0;  ///< their wear, m^3
    std::string worst;  ///< the unit with the largest deviation, by name if there are ties
    double ratio = 1;   ///< its energy over that of its closings
  };
  const Implausible& implausible() const { return implausible_; }
  double volume() const { return volume_; }  ///< of all units, m^3

 private:
  /// In fixed point, so that the order of the units does not matter.
  struct Sum {
    std::int64_t mean = 0, variance = 0;
  };
  static constexpr double probability_unit = 0x1p-36, energy_unit = 0x1p-8;
  std::size_t place(std::size_t level, std::size_t horizon) const {
    return (level * (horizons_.size() + days_.size()) + horizon) * models_;
  }
  UnitRow forecast(const UnitSums& sums, double per_day, std::vector<Sum>& reached) const;
  void describe(const UnitSums& sums);
  void balance(const UnitSums& sums);

  const WearModel& model_;
  std::size_t models_;
  std::vector<double> levels_, horizons_, days_;
  std::vector<Sum> sums_;
  std::size_t units_ = 0, units_outside_ = 0;
  std::array<std::vector<float>, duties> duty_;
  std::vector<float> worn_;
  std::int64_t energy_ = 0;
  double cycles_ = 0, outside_any_ = 0, negative_ = 0;
  std::array<double, 4> outside_{};
  Implausible implausible_;
  double volume_ = 0;
};

}  // namespace wearwell::clutch
