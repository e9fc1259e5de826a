#pragma once

#include <vector>

#include "wearwell/base/rng.h"
#include "wearwell/models/formula_model/rate_change.h"

namespace wearwell::formula_model {

/// Moves of particles whose target is the posterior of all readings of a unit, the last one in a power: the effects, the
/// place and the factor of each by the difference of two others (differential evolution; ter Braak 2006, Statistics and
/// Computing 16, 239-249), and the point of the population by an independent one with the same effects.
///
/// A reading that few particles explain enters in steps, as powers of its likelihood that leave half of the particles
/// effective; after each step they are resampled and moved (Del Moral, Doucet and Jasra 2006, J. R. Statist. Soc. B 68,
/// 411-436). In one step few distinct ones would be left, and moves by their differences could not spread them.
class RateChangeMoves {
 public:
  /// `all`: the readings along the axis, the last one at the end; `seen`: those of them in the study; `start`: no change
  /// before. `shared` must outlive it.
  RateChangeMoves(const RateChanges& shared, std::vector<UnitReading> all,
                  const std::vector<UnitReading>& seen, double start);

  /// Particles with weights before the last reading, whose likelihood is `last`, become `count` equal ones of the posterior
  /// after it.
  void take_last(ChangedUnits& units, std::vector<double> last, std::size_t count, Rng& rng) const;

 private:
  struct LogLikelihood {
    std::vector<double> earlier, last;
    double at(std::size_t i, double power) const { return earlier[i] + power * last[i]; }
  };
  LogLikelihood look(ChangedUnits& units) const;
  double log_prior(const ChangedUnits& units, std::size_t i) const;
  void move(ChangedUnits& units, double power, std::vector<double>& last, Rng& rng) const;
  // The distribution of the effects, of lognormal ones of their logarithms.
  struct NormalPopulation {
    double middle[2] = {}, scatter[2] = {1, 1}, correlation = 0;
    double log_pace = 0;  // of how fast effects change with their scores, up to a constant
  };
  static NormalPopulation normal_population(const FormulaModel& model, const Population& of);
  // What follows from the particles, one by one.
  struct Particles {
    std::vector<NormalPopulation> population;
    std::vector<double> normal[2];  // values of the effects, of lognormal ones their logarithms
    std::vector<double> log_prior;
  };
  Particles particles_of(const ChangedUnits& units) const;
  void place(const NormalPopulation& population, const double* normal, ChangedUnits& to,
             std::size_t i) const;
  void propose_differences(const ChangedUnits& from, const Particles& particles, double scale,
                           ChangedUnits& to, Rng& rng) const;
  std::vector<std::size_t> propose_points(const Particles& particles, ChangedUnits& to,
                                          Rng& rng) const;

  const RateChanges& shared_;
  const FormulaModel& model_;
  // Points of the population, not those of the unit without a change, which are chosen by its readings.
  const PopulationPoints& points_;
  std::vector<double> below_;                 // their cumulative weights before readings
  std::vector<NormalPopulation> population_;  // of each
  std::vector<UnitReading> all_;
  double start_, end_;
};

}  // namespace wearwell::formula_model
