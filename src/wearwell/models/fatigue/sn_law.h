#pragma once

#include <optional>

#include "wearwell/models/fatigue/mean_stress.h"
#include "wearwell/prob/standard_law.h"

namespace wearwell::fatigue {

/// How lives scatter about the S-N curve.
///
///   log10_normal  log10 life is normal, sigma its standard deviation (ISO 12107)
///   weibull       log10 life has the smallest extreme value law with scale sigma about the curve,
///                 so life is Weibull of shape 1/(sigma ln 10) and 63.2 % fail below the curve
///   normal        life itself is normal, sigma in cycles (Heo et al. 2011 as printed)
enum class LifeFamily { log10_normal, weibull, normal };

/// Basquin's law with a mean-stress correction: S_f = a N^b, S_f the fully reversed amplitude, N
/// cycles. With a random fatigue limit, S_f - limit = a N^b where S_f is above the item's limit,
/// and life has no end below it; log10 of the limit is normal or smallest extreme value over items
/// (Pascual and Meeker 1999).
struct SnLaw {
  MeanStress correction = MeanStress::goodman;
  LifeFamily family = LifeFamily::log10_normal;
  std::optional<double> strength;    ///< Pa, where it is known
  std::optional<double> gamma;       ///< Walker's, where it is known
  std::optional<StandardLaw> limit;  ///< the law of log10 of the fatigue limit, if there is one

  /// Parameters in order: log10 of a/Pa, b < 0, log10 of strength/Pa if unknown, gamma if unknown,
  /// sigma, then log10 of the median (or location) fatigue limit/Pa and its scale if there is one.
  bool has_strength() const { return !strength_name(correction).empty() && !strength; }
  bool has_gamma() const { return correction == MeanStress::walker && !gamma; }
  int strength_index() const { return 2; }
  int gamma_index() const { return 2 + has_strength(); }
  int sigma_index() const { return gamma_index() + has_gamma(); }
  int limit_index() const { return sigma_index() + 1; }
  int dimension() const { return limit_index() + (limit ? 2 : 0); }

  StandardLaw standard() const {
    return family == LifeFamily::weibull ? StandardLaw::smallest_extreme_value
                                         : StandardLaw::normal;
  }
  bool logarithmic() const { return family != LifeFamily::normal; }

  /// log10 of S_f/Pa.
  template <class T>
  T log10_reversed(const T* x, const Stress& stress) const {
    using std::exp;
    const T material =
        has_strength() ? T(exp(x[strength_index()] * std::log(10.0))) : T(strength.value_or(1));
    const T exponent = has_gamma() ? x[gamma_index()] : T(gamma.value_or(1));
    return std::log10(stress.alternating) + log10_factor(correction, stress, material, exponent);
  }

  /// log10 of the life on the curve of an item without fatigue limit.
  template <class T>
  T log10_life(const T* x, const T& log10_reversed) const {
    return (log10_reversed - x[0]) / x[1];
  }

  /// The same for an item of the population of fatigue limits: `z` is its place in the standard law
  /// of log10 of the limit. Infinite below the limit.
  double log10_life_of_item(const double* x, double log10_reversed, double z) const {
    const int i = limit_index();
    const double share = std::pow(10, x[i] + x[i + 1] * z - log10_reversed);
    if (!(share < 1)) return std::numeric_limits<double>::infinity();
    return log10_life(x, log10_reversed + std::log1p(-share) / std::log(10.0));
  }
};

}  // namespace wearwell::fatigue
