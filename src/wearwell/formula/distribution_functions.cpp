#include "wearwell/formula/distribution_functions.h"

#include <cmath>
#include <limits>

#include "wearwell/math/constants.h"
#include "wearwell/prob/family_functions.h"
#include "wearwell/prob/gamma.h"
#include "wearwell/prob/generalized_gamma.h"
#include "wearwell/prob/inverse_gaussian.h"
#include "wearwell/prob/student_t.h"

namespace wearwell::formula {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
using Slope = Dual<1>;

// A family with all parameters but one fixed. `y(x)` is the value of the family, here x.
struct GammaOfShape {
  using Family = families::Gamma;
  template <class T>
  struct Parameters {
    T s[2];
    explicit Parameters(const T& shape) : s{shape, T(1.0)} {}
  };
};
struct InverseGaussianOfShape {
  using Family = families::InverseGaussian;
  template <class T>
  struct Parameters {
    T s[2];
    explicit Parameters(const T& shape) : s{T(1.0), shape} {}
  };
};
struct GeneralizedGammaOfLambda {
  using Family = families::GeneralizedGamma;
  template <class T>
  struct Parameters {
    T s[3];
    explicit Parameters(const T& lambda) : s{T(1.0), T(1.0), lambda} {}
  };
};
struct StudentOfDegrees {
  using Family = families::StudentT;
  template <class T>
  struct Parameters {
    T s[3];
    explicit Parameters(const T& df) : s{df, T(0.0), T(1.0)} {}
  };
};

// exp(omega) is a number there; beyond, for |lambda| <= 1, both tails are below 1e-300.
constexpr double most_omega = 700;

template <class S, class Work>
double at(double x, double parameter, double below, double above, const Work& work) {
  using F = typename S::Family;
  const typename S::template Parameters<double> fixed(parameter);
  if (std::isnan(x) || !families::allowed<F>(fixed.s)) return not_a_number;
  if constexpr (std::is_same_v<F, families::GeneralizedGamma>) {
    if (std::abs(x) > most_omega) {
      if (std::isfinite(x) && std::abs(parameter) > 1) return not_a_number;
      return x < 0 ? below : above;
    }
  } else {
    if (x >= infinity) return above;
    if (F::positive ? !(x > 0) : x <= -infinity) return below;
  }
  return work(S());
}

template <class Work>
double of(Standard family, double x, double parameter, double below, double above,
          const Work& work) {
  switch (family) {
    case Standard::gamma:
      return at<GammaOfShape>(x, parameter, below, above, work);
    case Standard::inverse_gaussian:
      return at<InverseGaussianOfShape>(x, parameter, below, above, work);
    case Standard::generalized_gamma:
      return at<GeneralizedGammaOfLambda>(x, parameter, below, above, work);
    case Standard::student_t:
      return at<StudentOfDegrees>(x, parameter, below, above, work);
  }
  return not_a_number;
}

template <class S, class X>
auto value_at(const X& x) {
  using std::exp;
  if constexpr (std::is_same_v<typename S::Family, families::GeneralizedGamma>) {
    return X(exp(x));
  } else {
    return x;
  }
}

// The logarithm of the density of x; that of omega is the density of y times y.
template <class S, class X, class T>
auto log_pdf(const X& x, const typename S::template Parameters<T>& parameters) {
  using R = families::Result<X, T>;
  const R log_density = families::log_density<typename S::Family>(value_at<S>(x), parameters.s);
  if constexpr (std::is_same_v<typename S::Family, families::GeneralizedGamma>) {
    return R(log_density + x);
  } else {
    return log_density;
  }
}

// exp(log) and its derivative.
double slope_of(const Slope& log) {
  return std::isfinite(log.a) ? std::exp(log.a) * log.v[0] : 0;
}

}  // namespace

double standard_cdf(Standard family, double x, double parameter) {
  return of(family, x, parameter, 0, 1, [&]<class S>(S) {
    const typename S::template Parameters<double> p(parameter);
    return std::exp(families::log_cdf<typename S::Family>(value_at<S>(x), p.s));
  });
}

double standard_survival(Standard family, double x, double parameter) {
  return of(family, x, parameter, 1, 0, [&]<class S>(S) {
    const typename S::template Parameters<double> p(parameter);
    return std::exp(families::log_survival<typename S::Family>(value_at<S>(x), p.s));
  });
}

double standard_pdf(Standard family, double x, double parameter) {
  return of(family, x, parameter, 0, 0, [&]<class S>(S) {
    return std::exp(
        log_pdf<S, double, double>(x, typename S::template Parameters<double>(parameter)));
  });
}

double standard_quantile(Standard family, double p, double parameter) {
  if (!(p >= 0 && p <= 1)) return not_a_number;
  return of(family, 1, parameter, not_a_number, not_a_number, [&]<class S>(S) {
    const typename S::template Parameters<double> s(parameter);
    constexpr bool generalized = std::is_same_v<typename S::Family, families::GeneralizedGamma>;
    if (p == 0) return S::Family::positive && !generalized ? 0 : -infinity;
    if (p == 1) return infinity;
    const double y = families::quantile<typename S::Family>(p, s.s);
    return generalized ? std::log(y) : y;
  });
}

double cdf_slope(Standard family, double x, double parameter) {
  return of(family, x, parameter, 0, 0, [&]<class S>(S) {
    const typename S::template Parameters<Slope> p(Slope(parameter, 0));
    return slope_of(families::log_cdf<typename S::Family>(value_at<S>(x), p.s));
  });
}

double survival_slope(Standard family, double x, double parameter) {
  return of(family, x, parameter, 0, 0, [&]<class S>(S) {
    const typename S::template Parameters<Slope> p(Slope(parameter, 0));
    return slope_of(families::log_survival<typename S::Family>(value_at<S>(x), p.s));
  });
}

double pdf_slope(Standard family, double x, double parameter) {
  return of(family, x, parameter, 0, 0, [&]<class S>(S) {
    return slope_of(
        log_pdf<S, double, Slope>(x, typename S::template Parameters<Slope>(Slope(parameter, 0))));
  });
}

double pdf_slope_by_x(Standard family, double x, double parameter) {
  return of(family, x, parameter, 0, 0, [&]<class S>(S) {
    return slope_of(
        log_pdf<S, Slope, double>(Slope(x, 0), typename S::template Parameters<double>(parameter)));
  });
}

double quantile_slope(Standard family, double x, double parameter) {
  return -cdf_slope(family, x, parameter) / standard_pdf(family, x, parameter);
}

}  // namespace wearwell::formula
