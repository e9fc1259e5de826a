#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"
#include "wearwell/prob/family_form.h"
#include "wearwell/prob/standard_distribution.h"

/// What a family is, once for all that use it: a struct in a file of its own, with static members, and
/// a line in families.h. `s` are its parameters, in the order of `slots`; functions are templates over
/// the scalars of the observation and of the parameters (double or Dual).
///
///   name, slots       as studies have them
///   standard          if it has a location and a scale on some axis: the law there, with
///     z(u, s)           the place on it, u the observation, or of a positive family its logarithm
///     log_rate(u, s)    log dz/dy
///     inverse(z, s)     the observation
///   or else
///     log_density(y, s), log_cdf(y, s), log_survival(y, s)    inside the support
///     quantile(p, s)    0 < p < 1, if there is a formula
///   mean(s)           where it exists; else the median
///
/// and if wanted:
///
///   row<sloped>(u, s)    log density and slopes of one of many observations, in few operations
///   log_kernel(x, c), log_integral(c), tails(c)    where parameters are held fixed, as of a prior: the log density
///                     but for a constant, the log of its integral over the support of `tails`, and
///                     probabilities (tails.h); c = prepared(s), if there is such, or s
///   c_density, paper, title    see ResponseForm
namespace wearwell::families {

using std::exp;
using std::log;
using std::log1p;
using std::sqrt;

using enum ParameterKind;

template <class Y, class T>
using Result = decltype(std::declval<Y>() * std::declval<T>());

/// What holds of a family on the whole line where its file says nothing else.
struct OnLine {
  static constexpr bool positive = false, counted = false, prior_only = false;
  static constexpr std::string_view title = {};
  static constexpr Paper paper = {"normal", StandardDistribution::normal, false};
  static constexpr const char* c_density = nullptr;
};

/// The same of one above 0.
struct OnPositive : OnLine {
  static constexpr bool positive = true;
  static constexpr Paper paper = {"lognormal", StandardDistribution::normal, false};
};

/// A log density with its derivatives by two parameters.
struct Row {
  double value, slope[2];
};

/// Of the normal law of u.
inline Row normal_row(double u, double location, double scale) {
  const double inverse = 1 / scale, z = (u - location) * inverse;
  return {-0.5 * z * z - std::log(scale) - half_log_two_pi, {z * inverse, (z * z - 1) * inverse}};
}

}  // namespace wearwell::families
