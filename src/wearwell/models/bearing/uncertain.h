#pragma once

#include <string>
#include <string_view>

#include "wearwell/base/rng.h"
#include "wearwell/base/unit.h"

namespace wearwell {

/// A quantity with its uncertainty, as given by the user.
struct Uncertain {
  enum class Distribution { exact, normal, lognormal, uniform };
  Distribution distribution = Distribution::exact;
  double mean = 0;  ///< SI
  double sd = 0;    ///< SI
  /// SI: the value for an answer without uncertainty; mean, or the median of "x/"
  double centre = 0;
  Unit unit;         ///< of the mean, as written
  std::string text;  ///< as written
};

/// Reads one of
///   "0.1 mm"                           exact
///   "0.100 +- 0.005 mm", "1 MPa +- 5 %"  normal: mean and standard deviation (% of the mean)
///   "~ lognormal(0.1 mm, 0.005 mm)"    mean and standard deviation of the quantity itself
///   "~ normal(0.1 mm, 0.005 mm)", "~ uniform(0.09 mm, 0.11 mm)"
///   "1e-16 m^3/(N m) x/ 2"             lognormal: two thirds between half the median and twice the
///   median
/// with the dimension of the SI unit `si`. A ± counts as +-. Throws InputError.
Uncertain read_uncertain(std::string_view text, std::string_view si);

double draw(const Uncertain& quantity, Rng& rng);

/// The factor of "x/" that has the mean and standard deviation of `quantity`.
double equal_factor(const Uncertain& quantity);

}  // namespace wearwell
