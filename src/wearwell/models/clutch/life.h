#pragma once

#include <limits>
#include <string>
#include <vector>

#include "wearwell/models/clutch/wear_model.h"

namespace wearwell::clutch {

/// Interval of repetitions at which a level is reached; the upper end is infinite if the volume may
/// stay below it for ever.
struct LifeInterval {
  double low = 0, high = std::numeric_limits<double>::infinity();
};

/// "28 520 to 36 700"; "never" for an infinite end.
std::string description(const LifeInterval& interval);

/// When a wear level is reached under a repeated duty.
struct LifeAtLevel {
  double level = 0;           ///< share of the worn-out volume
  double repetitions = 0;     ///< with the run-in of a new plate
  double without_run_in = 0;  ///< the paper's n_x = level V_total/V_mu1
  double sd = 0;              ///< of the volume then, by the scatter of cycles, m^3
  double full_sd = 0;         ///< and by all that is uncertain, m^3
  double relative = 0;        ///< 2 sd/volume: half width of the 95 % interval
  double full_relative = 0;
  LifeInterval scatter, full;  ///< all repetitions after which volume +- 2 sd contains the level
};

struct Life {
  double energy = 0;     ///< of one repetition, J
  double volume = 0;     ///< of one repetition on a run-in plate, m^3
  double sd = 0;         ///< of it, m^3
  unsigned outside = 0;  ///< inputs outside the calibrated range at some cycle
  std::vector<LifeAtLevel> levels;
};

/// Life under `duty`, repeated cycles: a single one for an operating point (Haramina et al. 2025,
/// section 3.6, Figs. 19 and 20). The sum over the cycles is that of CycleSum, run-in taken at the
/// start of each; fractional repetitions are interpolated. Throws InputError for an empty duty, a
/// level that is not positive, or a duty that does not wear.
Life predict_life(const WearModel& model, const std::vector<Cycle>& duty,
                  const std::vector<double>& levels);

}  // namespace wearwell::clutch
