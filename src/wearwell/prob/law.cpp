#include "wearwell/prob/law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "wearwell/base/error.h"
#include "wearwell/prob/families.h"
#include "wearwell/prob/log_between.h"

namespace wearwell {
namespace {

using Parameters = std::array<double, most_response_slots>;

// A family whose kernel has an integral between two bounds alone.
template <class F>
concept BetweenBounds = requires {
  &F::log_integral_between;
};
// One whose kernel lacks a constant.
template <class F>
concept WithTails = requires(const double* c) {
  F::tails(c);
};

void require(const ResponseForm& form, std::size_t i, double value) {
  const SlotForm& slot = form.slots[i];
  if (families::holds(slot.kind, value)) return;
  const bool positive = slot.kind == SlotKind::size || slot.kind == SlotKind::number;
  throw InputError(fmt::format("{} law: {} is {}, it must be {}", form.name, slot.name, value,
                               positive ? "positive" : "finite"));
}

// P(lower < X < upper), by whichever tail does not cancel.
template <class Tails>
double probability(const Tails& law, double lower, double upper) {
  return law.below(lower) < 0.5 ? law.below(upper) - law.below(lower)
                                : law.above(lower) - law.above(upper);
}

// The same in logarithms, of any family.
template <class F>
double log_probability(const double* s, double lower, double upper) {
  return families::log_between<F>(lower, upper, s);
}

// What a prior takes of a family, each with one signature.
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

  // log of the kernel's integral between the bounds; what is not finite has none.
  static double log_integral(const Law& law) {
    const double* c = law.prepared.data();
    if constexpr (BetweenBounds<F>) {
      return F::log_integral_between(law.lower, law.upper);
    } else if constexpr (WithTails<F>) {
      const double whole = F::log_integral(c);
      if (!std::isfinite(whole)) {
        throw InputError(
            "the law's parameters are too extreme: its normalizing constant overflows");
      }
      return whole + std::log(probability(F::tails(c), law.lower, law.upper));
    } else {
      return log_probability<F>(c, law.lower, law.upper);
    }
  }

  static LogDensityAndSlope log_kernel(const Law& law, double x) {
    const Dual<1> at(x, 0);
    const double* c = law.prepared.data();
    if constexpr (requires { F::log_kernel(at, c); }) {
      const Dual<1> y = F::log_kernel(at, c);
      return {y.a, y.v[0]};
    } else {
      const Dual<1> y = families::log_density<F>(at, c);
      return {y.a, y.v[0]};
    }
  }

  static double quantile(const Law& law, double p) {
    const double* c = law.prepared.data();
    if constexpr (BetweenBounds<F>) {
      return F::quantile_between(p, law.lower, law.upper);
    } else if constexpr (WithTails<F>) {
      const auto whole = F::tails(c);
      const double below = whole.below(law.lower);
      return below < 0.5
                 ? whole.from_below(below * (1 - p) + whole.below(law.upper) * p)
                 : whole.from_above(whole.above(law.lower) * (1 - p) + whole.above(law.upper) * p);
    } else {
      const auto below = [&](double x) { return std::exp(log_probability<F>(c, -infinity, x)); };
      const auto above = [&](double x) { return std::exp(log_probability<F>(c, x, infinity)); };
      return below(law.lower) < 0.5
                 ? families::quantile<F>(below(law.lower) * (1 - p) + below(law.upper) * p, c)
                 : families::upper_quantile<F>(above(law.lower) * (1 - p) + above(law.upper) * p,
                                               c);
    }
  }
};

struct Functions {
  Parameters (*prepared)(const Parameters&);
  double (*lower)(const Parameters&);
  double (*upper)();
  double (*log_integral)(const Law&);
  LogDensityAndSlope (*log_kernel)(const Law&, double);
  double (*quantile)(const Law&, double);
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

const Functions& functions(const Law& law) {
  return table[static_cast<std::size_t>(law.family.id)];
}

}  // namespace

Law make_law(const Family& family, double lower, double upper) {
  const ResponseForm& form = form_of(family.id);
  for (std::size_t i = 0; i < form.slots.size(); ++i) require(form, i, family.parameter[i]);
  if (!(lower < upper)) {
    throw InputError(fmt::format("lower bound {} is not below upper bound {} (SI)", lower, upper));
  }
  Law law{family};
  const Functions& of = functions(law);
  law.lower = std::max(lower, of.lower(family.parameter));
  law.upper = std::min(upper, of.upper());
  law.prepared = of.prepared(family.parameter);
  if (!(law.lower < law.upper)) {
    throw InputError(
        fmt::format("bounds {} to {} (SI) lie outside the law's support", lower, upper));
  }
  const double log_integral = of.log_integral(law);
  law.proper = std::isfinite(log_integral) || !of.may_be_improper;
  if (!law.proper && family.id == ResponseFamily::uniform) {
    throw InputError("uniform law: needs both 'lower' and 'upper'");
  }
  if (law.proper && !std::isfinite(log_integral)) {
    throw InputError(fmt::format("the law has no probability between its bounds {} and {} (SI)",
                                 law.lower, law.upper));
  }
  if (law.proper) law.log_normalizer = log_integral;
  return law;
}

LogDensityAndSlope log_density(const Law& law, double x) {
  const LogDensityAndSlope y = functions(law).log_kernel(law, x);
  return {y.value - law.log_normalizer, y.slope};
}

double quantile(const Law& law, double p) {
  if (!law.proper) throw std::logic_error("quantile of an improper law");
  return std::clamp(functions(law).quantile(law, p), law.lower, law.upper);
}

}  // namespace wearwell
