#pragma once

#include <Eigen/Dense>
#include <array>
#include <string>
#include <vector>

#include "wearwell/fleet/engine.h"
#include "wearwell/models/clutch/life.h"
#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// The sums of one unit's cycles (ClutchSql::totals), SI.
struct UnitSums {
  std::string unit;
  double last_cycle = 0, cycles = 0;
  double refused = 0;   ///< rows with invalid values; not among `cycles`
  double repeated = 0;  ///< rows with a repeated number
  std::array<double, 4> outside{};
  double outside_any = 0, negative = 0;
  double energy = 0, volume = 0, variance = 0;
  double settled = 0;                ///< volume without run-in
  std::array<double, 4> inputs{};    ///< their sums; temperatures in degrees Celsius
  Eigen::ArrayXd volumes, settleds;  ///< of the replicates; empty without
};
UnitSums unit_sums(const fleet::Row& row, std::size_t replicates);

/// The wear of a unit now, and after more cycles of its own mean duty: n cycles, each with the mean
/// energy and the mean run-in volume. Run-in continues from the absorbed energy, at the start of
/// each cycle as in CycleSum.
class UnitForecast {
 public:
  UnitForecast(const WearModel& model, const UnitSums& sums);

  double volume(double more) const { return of(0, more); }
  /// Of replicate b, from 1; 0 is the model.
  double of(std::size_t b, double more) const;
  std::size_t replicates() const { return static_cast<std::size_t>(volume_.size()) - 1; }

  double scatter_sd(double more) const;
  double full_sd(double more) const;  ///< as PlateWear::full_sd

  /// Cycles from now until this volume; 0 if it is reached already, infinite if it never is.
  double until(double target) const;
  /// From the first cycle after which volume + 2 sd reaches the target to the last at which volume
  /// - 2 sd is below it.
  LifeInterval scatter_interval(double target) const;
  LifeInterval full_interval(double target) const;

  /// A unit with the scatter of its cycles and its own factor, after `more` cycles, given replicate
  /// b.
  struct Ahead {
    double mean = 0, sd = 0;
    double reached(double target) const;  ///< probability that it has
  };
  Ahead ahead(std::size_t b, double more) const;
  double reached(std::size_t b, double target, double more) const {
    return ahead(b, more).reached(target);
  }

 private:
  LifeInterval interval(double target, double (UnitForecast::*sd)(double) const) const;

  const WearModel& model_;
  double cycles_, variance_;
  /// By replicate: volume, mean volume of a cycle, remaining contribution of the two modes of
  /// run-in, and their rates per cycle.
  Eigen::ArrayXd volume_, rate_, slow_, fast_, slow_rate_, fast_rate_;
};

}  // namespace wearwell::clutch
