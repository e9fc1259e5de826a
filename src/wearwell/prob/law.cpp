#include "wearwell/prob/law.h"

#include <fmt/format.h>

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/inverse_gamma.hpp>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/math/boost_policy.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"

namespace wearwell {
namespace {

struct Support {
  double lower;
  double upper;
};

void require_positive(const char* law, const char* parameter, double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw InputError(fmt::format("{} law: {} is {}, it must be positive", law, parameter, value));
  }
}

void require_finite(const char* law, const char* parameter, double value) {
  if (!std::isfinite(value)) {
    throw InputError(fmt::format("{} law: {} is {}, it must be finite", law, parameter, value));
  }
}

// What a proper family is beside its kernel: its natural support, the logarithm of the kernel's
// integral over all of it, and Boost's distribution for probabilities and quantiles. Location and
// scale are taken out of Boost's hands where SI values as small as 1e-13 would meet its argument
// checks or underflow.
struct Properties {
  Support support;
  double log_integral;
};

Properties properties(const Normal& law) {
  require_finite("normal", "mean", law.mean);
  require_positive("normal", "sd", law.sd);
  return {{-infinity, infinity}, 0.5 * log_two_pi + std::log(law.sd)};
}
Properties properties(const Lognormal& law) {
  require_finite("lognormal", "log of the median", law.eta);
  require_positive("lognormal", "log_sd", law.zeta);
  return {{0, infinity}, 0.5 * log_two_pi + std::log(law.zeta)};
}
Properties properties(const Gamma& law) {
  require_positive("gamma", "shape", law.shape);
  require_positive("gamma", "scale", law.scale);
  return {{0, infinity}, boost::math::lgamma(law.shape, Quiet()) + law.shape * std::log(law.scale)};
}
Properties properties(const InverseGamma& law) {
  require_positive("inverse-gamma", "shape", law.shape);
  require_positive("inverse-gamma", "scale", law.scale);
  return {{0, infinity}, boost::math::lgamma(law.shape, Quiet()) - law.shape * std::log(law.scale)};
}
Properties properties(const StudentT& law) {
  require_positive("student-t", "df", law.df);
  require_finite("student-t", "location", law.location);
  require_positive("student-t", "scale", law.scale);
  return {{-infinity, infinity},
          std::log(boost::math::beta(0.5, 0.5 * law.df, Quiet())) + 0.5 * std::log(law.df) +
              std::log(law.scale)};
}
Properties properties(const Beta& law) {
  require_positive("beta", "alpha", law.alpha);
  require_positive("beta", "beta", law.beta);
  // Of gammas: the beta function itself underflows from alpha = beta = 515 on.
  return {{0, 1},
          boost::math::lgamma(law.alpha, Quiet()) + boost::math::lgamma(law.beta, Quiet()) -
              boost::math::lgamma(law.alpha + law.beta, Quiet())};
}
Properties properties(const Flat&) {
  return {{-infinity, infinity}, 0};
}
Properties properties(const Uniform&) {
  return {{-infinity, infinity}, 0};
}
Properties properties(const Jeffreys&) {
  return {{0, infinity}, 0};
}

// P(X <= x), P(X > x) and their inverses for each proper family, on the family's natural support.
template <class Distribution>
struct Standardized {
  Distribution distribution;
  double location = 0;
  double scale = 1;

  double below(double x) const {
    return at(x, 0, 1, [&](double z) { return cdf(distribution, z); });
  }
  double above(double x) const {
    return at(x, 1, 0, [&](double z) { return cdf(complement(distribution, z)); });
  }
  double from_below(double p) const { return location + scale * quantile(distribution, p); }
  double from_above(double q) const {
    return location + scale * quantile(complement(distribution, q));
  }

 private:
  template <class F>
  double at(double x, double at_lowest, double at_highest, const F& f) const {
    const auto [lowest, highest] = boost::math::support(distribution);
    const double z = (x - location) / scale;
    if (z <= lowest) return at_lowest;
    if (z >= highest) return at_highest;
    return f(z);
  }
};

template <class Distribution>
Standardized<Distribution> standardized(const Distribution& distribution, double location,
                                        double scale) {
  return {distribution, location, scale};
}

auto standardized(const Normal& law) {
  return standardized(boost::math::normal_distribution<double, Quiet>(), law.mean, law.sd);
}
auto standardized(const Lognormal& law) {
  return standardized(boost::math::lognormal_distribution<double, Quiet>(0, law.zeta), 0.0,
                      std::exp(law.eta));
}
auto standardized(const Gamma& law) {
  return standardized(boost::math::gamma_distribution<double, Quiet>(law.shape, 1), 0.0, law.scale);
}
auto standardized(const InverseGamma& law) {
  return standardized(boost::math::inverse_gamma_distribution<double, Quiet>(law.shape, 1), 0.0,
                      law.scale);
}
auto standardized(const StudentT& law) {
  return standardized(boost::math::students_t_distribution<double, Quiet>(law.df), law.location,
                      law.scale);
}
auto standardized(const Beta& law) {
  return standardized(boost::math::beta_distribution<double, Quiet>(law.alpha, law.beta), 0.0, 1.0);
}

// P(lower < X < upper), by whichever tail does not cancel.
template <class S>
double probability(const S& law, double lower, double upper) {
  return law.below(lower) < 0.5 ? law.below(upper) - law.below(lower)
                                : law.above(lower) - law.above(upper);
}

bool finite(const Law& law) {
  return std::isfinite(law.lower) && std::isfinite(law.upper);
}

struct Normalize {
  Law& law;
  double log_integral;

  template <class F>
  void operator()(const F& family) const {
    const double mass = probability(standardized(family), law.lower, law.upper);
    if (!(mass > 0)) {
      throw InputError(fmt::format("the law has no probability between its bounds {} and {} (SI)",
                                   law.lower, law.upper));
    }
    law.log_normalizer = log_integral + std::log(mass);
  }
  void operator()(const Flat&) const {
    law.proper = finite(law);
    if (law.proper) law.log_normalizer = std::log(law.upper - law.lower);
  }
  void operator()(const Uniform&) const {
    if (!finite(law)) throw InputError("uniform law: needs both 'lower' and 'upper'");
    law.log_normalizer = std::log(law.upper - law.lower);
  }
  void operator()(const Jeffreys&) const {
    law.proper = finite(law) && law.lower > 0;
    if (law.proper) law.log_normalizer = std::log(std::log(law.upper / law.lower));
  }
};

struct Quantile {
  const Law& law;
  double p;

  template <class F>
  double operator()(const F& family) const {
    const auto whole = standardized(family);
    const double x =
        whole.below(law.lower) < 0.5
            ? whole.from_below(whole.below(law.lower) * (1 - p) + whole.below(law.upper) * p)
            : whole.from_above(whole.above(law.lower) * (1 - p) + whole.above(law.upper) * p);
    return std::clamp(x, law.lower, law.upper);
  }
  double operator()(const Flat&) const { return law.lower + p * (law.upper - law.lower); }
  double operator()(const Uniform&) const { return law.lower + p * (law.upper - law.lower); }
  double operator()(const Jeffreys&) const {
    return law.lower * std::pow(law.upper / law.lower, p);
  }
};

}  // namespace

Law make_law(const Family& family, double lower, double upper) {
  const Properties natural = std::visit([](const auto& f) { return properties(f); }, family);
  if (!(lower < upper)) {
    throw InputError(fmt::format("lower bound {} is not below upper bound {} (SI)", lower, upper));
  }
  if (!std::isfinite(natural.log_integral)) {
    throw InputError("the law's parameters are too extreme: its normalizing constant overflows");
  }
  Law law{family, std::max(lower, natural.support.lower), std::min(upper, natural.support.upper)};
  if (!(law.lower < law.upper)) {
    throw InputError(
        fmt::format("bounds {} to {} (SI) lie outside the law's support", lower, upper));
  }
  std::visit(Normalize{law, natural.log_integral}, family);
  return law;
}

LogDensityAndSlope log_density(const Law& law, double x) {
  const Dual<1> y =
      std::visit([x](const auto& f) { return log_kernel(f, Dual<1>(x, 0)); }, law.family);
  return {y.a - law.log_normalizer, y.v[0]};
}

double quantile(const Law& law, double p) {
  if (!law.proper) throw std::logic_error("quantile of an improper law");
  return std::visit(Quantile{law, p}, law.family);
}

}  // namespace wearwell
