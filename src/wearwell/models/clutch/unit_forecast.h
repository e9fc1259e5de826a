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
  double refused = 0;   ///< rows without values that can be; not among `cycles`
  double repeated = 0;  ///< rows whose number another row has too
  std::array<double, 4> outside{};
  double outside_any = 0, negative = 0;
  double energy = 0, volume = 0, variance = 0;
  double settled = 0;                ///< volume without run-in
  std::array<double, 4> inputs{};    ///< their sums; temperatures in degrees Celsius
  Eigen::ArrayXd volumes, settleds;  ///< of the replicates; empty without
};
UnitSums unit_sums(const fleet::Row& row, std::size_t replicates);

/// What a unit's wear is, and will be after more cycles of its own mean duty: n cycles, each of the
/// mean energy and of the mean volume of one that is run in. Run-in goes on from the energy that it
/// has taken up, at the start of each cycle as in CycleSum.
class UnitForecast {
 public:
  UnitForecast(const WearModel& model, const UnitSums& sums);

  double volume(double more) const { return of(0, more); }
  /// Of replicate b, from 1; 0 is the model.
  double of(std::size_t b, double more) const;
  std::size_t replicates() const { return static_cast<std::size_t>(volume_.size()) - 1; }

  double scatter_sd(double more) const;
  double full_sd(double more) const;  ///< as PlateWear::full_sd

  /// Cycles from now until the volume is that; 0 where it is already, infinite where it never will be.
  double until(double target) const;
  /// From the first cycle after which volume + 2 sd holds the target to the last before volume - 2 sd
  /// does.
  LifeInterval scatter_interval(double target) const;
  LifeInterval full_interval(double target) const;

  /// A unit of its kind, with the scatter of its cycles and a factor of its own, after `more` cycles if
  /// replicate b is true.
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
  /// By replicate: volume, mean volume of a cycle, what is left of the two modes of run-in, and their rates a cycle.
  Eigen::ArrayXd volume_, rate_, slow_, fast_, slow_rate_, fast_rate_;
};

}  // namespace wearwell::clutch
