#pragma once

#include <optional>

#include "wearwell/math/constants.h"
#include "wearwell/models/fatigue/mean_stress.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell::fatigue {

/// The scatter of lives about the S-N curve.
///
///   log10_normal  log10 life is normal, sigma its standard deviation (ISO 12107)
///   weibull       log10 life has the smallest extreme value distribution with scale sigma about
///   the curve,
///                 so life is Weibull of shape 1/(sigma ln 10) and 63.2 % fail below the curve
///   normal        life itself is normal, sigma in cycles (Heo et al. 2011 as printed)
enum class LifeFamily { log10_normal, weibull, normal };

/// The S-N curve: life N in cycles against the fully reversed stress S.
///
///   basquin     S = a N^b
///   knee        N = N_D (S/S_D)^-k, below S_D with k2 instead of k; or, if each item has its own
///   limit
///               about S_D, the first line above it and infinite life below
///   stromeyer   S - limit = a N^b, infinite life below the limit (Stromeyer 1914)
///   bastenaire  N = N_B B/(S - limit) exp(-((S - limit)/B)^C) (Bastenaire 1972)
///   strain_life S, a strain, = elastic (2N)^b + plastic (2N)^c (Coffin, Manson, Basquin)
enum class SnCurve { basquin, knee, stromeyer, bastenaire, strain_life };

/// The slope k2: a parameter, or 2k - 1 (Haibach 1970), or infinite: a horizontal limit, which then
/// is random.
enum class SecondSlope { free, haibach, infinite };

/// An S-N curve with a mean-stress correction and scatter about it. With Basquin's curve and a
/// random fatigue limit, S - limit = a N^b if S is above the item's limit, and life is infinite
/// below it; log10 of the limit is normal or smallest extreme value over items (Pascual and Meeker
/// 1999).
struct SnLaw {
  MeanStress correction = MeanStress::goodman;
  LifeFamily family = LifeFamily::log10_normal;
  std::optional<double> strength;  ///< Pa, if known
  std::optional<double> gamma;     ///< Walker's, if known
  /// the distribution of log10 of the fatigue limit, if there is one
  std::optional<StandardDistribution> limit;
  SnCurve curve = SnCurve::basquin;  ///< with a limit: basquin or knee
  SecondSlope second_slope = SecondSlope::free;
  /// sigma is the scatter at `scatter_at` cycles, and sigma (N/scatter_at)^growth at others.
  bool scatter_grows = false;
  static constexpr double log10_scatter_at = 6;

  /// Parameters in order: of the curve (log10 of a/Pa, b < 0; k, log10 of N_D, log10 of S_D/Pa, k2 if
  /// free; log10 of a/Pa, b, log10 of limit/Pa; log10 of N_B, log10 of B/Pa, C, log10 of limit/Pa;
  /// log10 of elastic, b, log10 of plastic, c),
  /// log10 of strength/Pa if unknown, gamma if unknown, sigma, its growth if it grows, then log10 of the
  /// median (or location) fatigue limit/Pa and its scale if there is one (of a knee this is S_D).
  int curve_dimension() const {
    switch (curve) {
      case SnCurve::knee:
        return limit ? 2 : second_slope == SecondSlope::free ? 4 : 3;
      case SnCurve::stromeyer:
        return 3;
      case SnCurve::bastenaire:
      case SnCurve::strain_life:
        return 4;
      case SnCurve::basquin:
        break;
    }
    return 2;
  }
  bool has_strength() const { return divides_by_strength(correction) && !strength; }
  bool has_gamma() const { return correction == MeanStress::walker && !gamma; }
  int strength_index() const { return curve_dimension(); }
  int gamma_index() const { return curve_dimension() + has_strength(); }
  int sigma_index() const { return gamma_index() + has_gamma(); }
  int growth_index() const { return sigma_index() + 1; }
  int limit_index() const { return sigma_index() + 1 + scatter_grows; }
  int dimension() const { return limit_index() + (limit ? 2 : 0); }

  /// Whether lives are an integral over the limit; otherwise they have a closed form.
  bool integrated() const { return limit && curve == SnCurve::basquin; }
  /// Whether the S-N line is curved.
  bool bends() const { return limit || curve != SnCurve::basquin; }
  bool straight() const { return !bends() && !scatter_grows; }

  StandardDistribution standard() const {
    return family == LifeFamily::weibull ? StandardDistribution::smallest_extreme_value
                                         : StandardDistribution::normal;
  }
  bool logarithmic() const { return family != LifeFamily::normal; }

  /// Pa; 1 if the correction has none.
  template <class T>
  T strength_at(const T* x) const {
    using std::exp;
    return has_strength() ? T(exp(x[strength_index()] * std::log(10.0))) : T(strength.value_or(1));
  }
  template <class T>
  T gamma_at(const T* x) const {
    return has_gamma() ? x[gamma_index()] : T(gamma.value_or(1));
  }

  /// log10 of S_f/Pa.
  template <class T>
  T log10_reversed(const T* x, const Stress& stress) const {
    return std::log10(stress.alternating) +
           log10_factor(correction, stress, strength_at(x), gamma_at(x));
  }

  /// log10 of the life on the curve; for an item whose own limit is not reached. Infinite below a
  /// common limit.
  template <class T>
  T log10_life(const T* x, const T& log10_reversed) const {
    using std::exp;
    using std::log;
    const double decade = std::log(10.0);
    // log10 of S - limit.
    const auto above = [&](const T& log10_limit) {
      const T rest = 1.0 - exp((log10_limit - log10_reversed) * decade);
      return rest > 0.0 ? T(log10_reversed + log(rest) / decade) : T(-infinity);
    };
    switch (curve) {
      case SnCurve::knee: {
        const T at = limit ? x[limit_index()] : x[2];
        const T k = limit || log10_reversed >= at          ? x[0]
                    : second_slope == SecondSlope::haibach ? T(2.0 * x[0] - 1.0)
                                                           : x[3];
        return x[1] - k * (log10_reversed - at);
      }
      case SnCurve::stromeyer: {
        const T rest = above(x[2]);
        if (scalar(rest) == -infinity) return T(infinity);
        return (rest - x[0]) / x[1];
      }
      case SnCurve::bastenaire: {
        const T rest = above(x[3]) - x[1];
        if (scalar(rest) == -infinity) return T(infinity);
        return x[0] - rest - exp(rest * decade * x[2]) / decade;
      }
      case SnCurve::strain_life: {
        // Solved for plain numbers; one more Newton step gives the derivatives.
        const double plain[] = {scalar(x[0]), scalar(x[1]), scalar(x[2]), scalar(x[3])};
        const double y = log10_reversals(plain, scalar(log10_reversed));
        if (!std::isfinite(y)) return T(y);
        const T elastic = (x[0] + x[1] * y) * decade, plastic = (x[2] + x[3] * y) * decade;
        const bool more = elastic > plastic;
        const T &larger = more ? elastic : plastic, &smaller = more ? plastic : elastic;
        const T strain = (larger + log(1.0 + exp(smaller - larger))) / decade;
        const double share = 1 / (1 + std::exp(scalar(plastic) - scalar(elastic)));
        const double slope = share * plain[1] + (1 - share) * plain[3];
        return y - std::log10(2.0) - (strain - log10_reversed) / slope;
      }
      case SnCurve::basquin:
        break;
    }
    return (log10_reversed - x[0]) / x[1];
  }

  /// log10 of the reversals 2N of a strain-life curve at the logarithm of a strain: the sum of both
  /// lines is convex and decreasing, so that Newton's method from the longer of their own lives
  /// approaches from the left without overshooting.
  static double log10_reversals(const double* x, double log10_strain) {
    const double decade = std::log(10.0);
    double y = std::max((log10_strain - x[0]) / x[1], (log10_strain - x[2]) / x[3]);
    for (int i = 0; i < 100 && std::isfinite(y); ++i) {
      const double elastic = x[0] + x[1] * y, plastic = x[2] + x[3] * y;
      const double larger = std::max(elastic, plastic);
      const double strain =
          larger + std::log1p(std::exp(-std::abs(elastic - plastic) * decade)) / decade;
      const double share = 1 / (1 + std::exp((plastic - elastic) * decade));
      const double step = (strain - log10_strain) / (share * x[1] + (1 - share) * x[3]);
      y -= step;
      if (std::abs(step) <= 1e-14 * (1 + std::abs(y))) break;
    }
    return y;
  }

  /// The scatter of lives about a point of the curve, which log10_life gives.
  template <class T>
  T sigma_at(const T* x, const T& log10_life) const {
    using std::exp;
    if (!scatter_grows) return x[sigma_index()];
    constexpr double most = 6;  // decades; constant farther out
    const double shift = scalar(log10_life) - log10_scatter_at;
    const T decades =
        std::abs(shift) < most ? T(log10_life - log10_scatter_at) : T(std::copysign(most, shift));
    return x[sigma_index()] * exp(std::log(10.0) * x[growth_index()] * decades);
  }

  /// The score of a stress in the standard distribution of log10 of the limit, for random limits.
  template <class T>
  T limit_place(const T* x, const T& log10_reversed) const {
    return (log10_reversed - x[limit_index()]) / x[limit_index() + 1];
  }

  /// The life on the curve of an item of the population of fatigue limits: `z` is its score in the
  /// standard distribution of log10 of the limit. Infinite below the limit.
  double log10_life_of_item(const double* x, double log10_reversed, double z) const {
    const int i = limit_index();
    const double share = std::pow(10, x[i] + x[i + 1] * z - log10_reversed);
    if (!(share < 1)) return std::numeric_limits<double>::infinity();
    if (curve == SnCurve::knee) return log10_life(x, log10_reversed);
    return log10_life(x, log10_reversed + std::log1p(-share) / std::log(10.0));
  }
};

}  // namespace wearwell::fatigue
