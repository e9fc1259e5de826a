#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"

namespace wearwell::fatigue {

/// A cycle of stress, Pa: between mean - alternating and mean + alternating; alternating > 0.
struct Stress {
  double alternating = 0;
  double mean = 0;
};

/// What stays constant when the alternating stress grows: the mean stress, or the ratio R of
/// smallest to largest stress.
struct StressLine {
  double mean = 0;              ///< Pa, if there is no ratio
  std::optional<double> ratio;  ///< R < 1

  Stress at(double alternating) const {
    return {alternating, ratio ? alternating * (1 + *ratio) / (1 - *ratio) : mean};
  }
};

/// Mean-stress correction: the fully reversed amplitude S_f that is as damaging.
///
///   none      S_f = S_a
///   goodman   S_f = S_a/(1 - S_m/S_ut)                 S_ut ultimate strength
///   gerber    S_f = S_a/(1 - (S_m/S_ut)^2)             S_a where S_m < 0
///   soderberg S_f = S_a/(1 - S_m/S_y)                  S_y yield strength
///   morrow    S_f = S_a/(1 - S_m/sigma_f)              sigma_f true fracture strength
///   swt       S_f = sqrt((S_m + S_a) S_a)              Smith, Watson and Topper (1970)
///   walker    S_f = (S_m + S_a)^(1 - gamma) S_a^gamma  Walker (1970); gamma = 1/2 is swt
///
/// Above the strength no cycle is possible; with swt and walker a cycle without tension does no
/// damage.
enum class MeanStress { none, goodman, gerber, soderberg, morrow, swt, walker };

const std::vector<std::string>& mean_stress_names();
std::optional<MeanStress> mean_stress_named(const std::string& name);

/// The strength that the correction divides by: "S_ut", "S_y" or "sigma_f"; empty for the others.
std::string_view strength_name(MeanStress correction);

inline bool divides_by_strength(MeanStress correction) {
  return correction == MeanStress::goodman || correction == MeanStress::gerber ||
         correction == MeanStress::soderberg || correction == MeanStress::morrow;
}

/// log10(S_f/S_a): infinite if the mean stress reaches the strength, -infinite if the cycle does no
/// damage. `strength` [Pa] and `gamma` matter only to corrections that use them.
template <class T>
T log10_factor(MeanStress correction, const Stress& stress, const T& strength, const T& gamma) {
  using std::log;
  const double per_decade = 1 / std::log(10.0);
  switch (correction) {
    case MeanStress::none:
      break;
    case MeanStress::goodman:
    case MeanStress::soderberg:
    case MeanStress::morrow: {
      const T reserve = 1.0 - stress.mean / strength;
      if (!(reserve > 0.0)) return T(infinity);
      return -per_decade * log(reserve);
    }
    case MeanStress::gerber: {
      if (stress.mean <= 0) break;
      const T share = stress.mean / strength;
      const T reserve = 1.0 - share * share;
      if (!(reserve > 0.0)) return T(infinity);
      return -per_decade * log(reserve);
    }
    case MeanStress::swt:
    case MeanStress::walker: {
      const double largest = 1 + stress.mean / stress.alternating;
      if (!(largest > 0)) return T(-infinity);
      return (correction == MeanStress::swt ? T(0.5) : 1.0 - gamma) * std::log10(largest);
    }
  }
  return T(0);
}

/// The alternating stress [Pa] along a line whose fully reversed amplitude is `reversed` [Pa]: 0 if
/// the mean stress alone reaches the strength, infinite if no cycle is as damaging.
double alternating_stress(MeanStress correction, double reversed, const StressLine& line,
                          double strength, double gamma);

}  // namespace wearwell::fatigue
