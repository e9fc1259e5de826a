#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"
#include "wearwell/prob/family_form.h"
#include "wearwell/prob/standard_distribution.h"

/// The definition of a family: a struct with static members in its own file, and a line in
/// families.h. `s` are its parameters, in the order of `family_parameters`; functions are templates over the
/// scalars of the observation and of the parameters (double or Dual).
///
///   name, slots       as studies have them
///   standard          if it has a location and a scale on some axis: the distribution there, with
///     z(u, s)           the position on it, u the observation, or its logarithm for a positive family
///     log_rate(u, s)    log dz/dy
///     inverse(z, s)     the observation
///   or else
///     log_density(y, s), log_cdf(y, s), log_survival(y, s)    inside the support
///     quantile(p, s)    0 < p < 1, if there is a formula
///   mean(s)           if it exists; else the median
///
/// and optionally:
///
///   row<sloped>(u, s, log_s)    log density and slopes of one of many observations, optimized; log_s has
///                     log_of_first(s[0]) and log_of_second(s[1]), computed once where all rows share them
///   log_kernel(x, c), log_integral(c), tails(c)    for fixed parameters, as in a prior: the log density
///                     up to a constant, the log of its integral over the support of `tails`, and
///                     probabilities (tails.h); c = prepared(s) if defined, else s
///   c_density, paper, title    see ResponseForm
namespace wearwell::families {

using std::exp;
using std::log;
using std::log1p;
using std::sqrt;

using enum ParameterKind;

template <class Y, class T>
using Result = decltype(std::declval<Y>() * std::declval<T>());

/// Defaults for a family on the whole real line.
struct OnLine {
  static constexpr bool positive = false, counted = false, prior_only = false;
  static constexpr std::string_view title = {};
  static constexpr Paper paper = {"normal", StandardDistribution::normal, false};
  static constexpr const char* c_density = nullptr;
};

/// Defaults for a family above 0.
struct OnPositive : OnLine {
  static constexpr bool positive = true;
  static constexpr Paper paper = {"lognormal", StandardDistribution::normal, false};
};

/// A log density with its derivatives by two parameters.
struct Row {
  double value, slope[2];
};

/// For the normal distribution of u.
inline Row normal_row(double u, double location, double scale, double log_scale) {
  const double inverse = 1 / scale, z = (u - location) * inverse;
  return {-0.5 * z * z - log_scale - half_log_two_pi, {z * inverse, (z * z - 1) * inverse}};
}

}  // namespace wearwell::families
