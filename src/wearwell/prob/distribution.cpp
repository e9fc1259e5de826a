#include "wearwell/prob/distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "wearwell/base/error.h"
#include "wearwell/prob/families.h"
#include "wearwell/prob/log_between.h"

namespace wearwell {
namespace {

using Parameters = std::array<double, most_response_parameters>;

// A family whose kernel is integrable only between two bounds.
template <class F>
concept BetweenBounds = requires {
  &F::log_integral_between;
};
// A family whose kernel omits a constant.
template <class F>
concept WithTails = requires(const double* c) {
  F::tails(c);
};

void require(const ResponseForm& form, std::size_t i, double value) {
  const ParameterForm& family_parameter = form.family_parameters[i];
  if (families::holds(family_parameter.kind, value)) return;
  const bool positive = family_parameter.kind == ParameterKind::scale ||
                        family_parameter.kind == ParameterKind::number;
  throw InputError(fmt::format("{} distribution: {} is {}, but must be {}", form.name,
                               family_parameter.name, value, positive ? "positive" : "finite"));
}

// P(lower < X < upper), from the tail without cancellation.
template <class Tails>
double probability(const Tails& distribution, double lower, double upper) {
  return distribution.below(lower) < 0.5 ? distribution.below(upper) - distribution.below(lower)
                                         : distribution.above(lower) - distribution.above(upper);
}

// The same in logarithms, for any family.
template <class F>
double log_probability(const double* s, double lower, double upper) {
  return families::log_between<F>(lower, upper, s);
}

// The functions of a family that a prior needs, with uniform signatures.
template <class F>
struct Of {
  static Parameters prepared(const Parameters& s) {
    if constexpr (requires { F::prepared(s.data()); }) {
      return F::prepared(s.data());
    } else {
      return s;
    }
  }
  static double lower(const Parameters& s) { return families::lower_end<F>(s.data()); }
  static double upper() {
    if constexpr (requires { F::upper; }) {
      return F::upper;
    } else {
      return infinity;
    }
  }

  // log of the kernel's integral between the bounds; improper if not finite.
  static double log_integral(const Distribution& distribution) {
    const double* c = distribution.prepared.data();
    if constexpr (BetweenBounds<F>) {
      return F::log_integral_between(distribution.lower, distribution.upper);
    } else if constexpr (WithTails<F>) {
      const double whole = F::log_integral(c);
      if (!std::isfinite(whole)) {
        throw InputError(
            "the parameters of the distribution are too extreme: its normalizing constant "
            "overflows");
      }
      return whole + std::log(probability(F::tails(c), distribution.lower, distribution.upper));
    } else {
      return log_probability<F>(c, distribution.lower, distribution.upper);
    }
  }

  static LogDensityAndSlope log_kernel(const Distribution& distribution, double x) {
    const Dual<1> at(x, 0);
    const double* c = distribution.prepared.data();
    if constexpr (requires { F::log_kernel(at, c); }) {
      const Dual<1> y = F::log_kernel(at, c);
      return {y.a, y.v[0]};
    } else {
      const Dual<1> y = families::log_density<F>(at, c);
      return {y.a, y.v[0]};
    }
  }

  static double quantile(const Distribution& distribution, double p) {
    const double* c = distribution.prepared.data();
    if constexpr (BetweenBounds<F>) {
      return F::quantile_between(p, distribution.lower, distribution.upper);
    } else if constexpr (WithTails<F>) {
      const auto whole = F::tails(c);
      const double below = whole.below(distribution.lower);
      return below < 0.5 ? whole.from_below(below * (1 - p) + whole.below(distribution.upper) * p)
                         : whole.from_above(whole.above(distribution.lower) * (1 - p) +
                                            whole.above(distribution.upper) * p);
    } else {
      const auto below = [&](double x) { return std::exp(log_probability<F>(c, -infinity, x)); };
      const auto above = [&](double x) { return std::exp(log_probability<F>(c, x, infinity)); };
      return below(distribution.lower) < 0.5
                 ? families::quantile<F>(
                       below(distribution.lower) * (1 - p) + below(distribution.upper) * p, c)
                 : families::upper_quantile<F>(
                       above(distribution.lower) * (1 - p) + above(distribution.upper) * p, c);
    }
  }
};

struct Functions {
  Parameters (*prepared)(const Parameters&);
  double (*lower)(const Parameters&);
  double (*upper)();
  double (*log_integral)(const Distribution&);
  LogDensityAndSlope (*log_kernel)(const Distribution&, double);
  double (*quantile)(const Distribution&, double);
  bool may_be_improper;
};

constexpr families::FamilyTable<Functions> table = [] {
  families::FamilyTable<Functions> all{};
  families::for_each_family([&all]<class F>(std::size_t i) {
    if constexpr (!families::Base<F>::counted) {
      all[i] = {Of<F>::prepared,   Of<F>::lower,    Of<F>::upper,    Of<F>::log_integral,
                Of<F>::log_kernel, Of<F>::quantile, BetweenBounds<F>};
    }
  });
  return all;
}();

const Functions& functions(const Distribution& distribution) {
  return table[static_cast<std::size_t>(distribution.family.id)];
}

}  // namespace

Distribution make_distribution(const Family& family, double lower, double upper) {
  const ResponseForm& form = form_of(family.id);
  for (std::size_t i = 0; i < form.family_parameters.size(); ++i)
    require(form, i, family.parameter[i]);
  if (!(lower < upper)) {
    throw InputError(fmt::format("lower bound {} is not below upper bound {} (SI)", lower, upper));
  }
  Distribution distribution{family};
  const Functions& of = functions(distribution);
  distribution.lower = std::max(lower, of.lower(family.parameter));
  distribution.upper = std::min(upper, of.upper());
  distribution.prepared = of.prepared(family.parameter);
  if (!(distribution.lower < distribution.upper)) {
    throw InputError(fmt::format("bounds {} to {} (SI) lie outside the support of the distribution",
                                 lower, upper));
  }
  const double log_integral = of.log_integral(distribution);
  distribution.proper = std::isfinite(log_integral) || !of.may_be_improper;
  if (!distribution.proper && family.id == ResponseFamily::uniform) {
    throw InputError("uniform distribution: needs both 'lower' and 'upper'");
  }
  if (distribution.proper && !std::isfinite(log_integral)) {
    throw InputError(
        fmt::format("the distribution has no probability between its bounds {} and {} (SI)",
                    distribution.lower, distribution.upper));
  }
  if (distribution.proper) distribution.log_normalizer = log_integral;
  return distribution;
}

LogDensityAndSlope log_density(const Distribution& distribution, double x) {
  const LogDensityAndSlope y = functions(distribution).log_kernel(distribution, x);
  return {y.value - distribution.log_normalizer, y.slope};
}

double quantile(const Distribution& distribution, double p) {
  if (!distribution.proper) throw std::logic_error("quantile of an improper distribution");
  return std::clamp(functions(distribution).quantile(distribution, p), distribution.lower,
                    distribution.upper);
}

}  // namespace wearwell
