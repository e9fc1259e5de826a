#pragma once

#include <cmath>

#include "wearwell/prob/family.h"
#include "wearwell/prob/quantile_root.h"
#include "wearwell/prob/standard_values.h"

/// The functions of any family, derived from its definition (family.h).
namespace wearwell::families {

/// A positive family with a threshold as its last parameter: the value minus the threshold has the
/// family's distribution.
template <class F>
struct WithThreshold {
  using Base = F;
  static constexpr std::size_t threshold = F::family_parameters.size();
};

template <class F>
concept Thresholded = requires {
  typename F::Base;
};
template <class F>
concept OnStandardAxis = requires {
  F::standard;
};

template <class F>
struct BaseOf {
  using type = F;
};
template <class F>
struct BaseOf<WithThreshold<F>> {
  using type = F;
};
template <class F>
using Base = typename BaseOf<F>::type;

template <class F>
constexpr std::size_t parameter_count() {
  if constexpr (Thresholded<F>) {
    return F::threshold + 1;
  } else {
    return F::family_parameters.size();
  }
}

inline bool holds(ParameterKind kind, double x) {
  switch (kind) {
    case ParameterKind::scale:
    case ParameterKind::number:
      return x > 0 && x < infinity;
    case ParameterKind::probability:
      return x >= 0 && x <= 1;
    default:
      return std::isfinite(x);
  }
}

/// Whether each parameter is valid for its kind.
template <class F, class T>
bool allowed(const T* s) {
  if constexpr (requires(double x) { F::allows(x); }) {
    return F::allows(scalar(s[0]));
  } else if constexpr (Thresholded<F>) {
    return allowed<typename F::Base>(s) && std::isfinite(scalar(s[F::threshold]));
  } else {
    for (std::size_t i = 0; i < F::family_parameters.size(); ++i)
      if (!holds(F::family_parameters[i].kind, scalar(s[i]))) return false;
    return true;
  }
}

/// The lower end of the support.
template <class F, class T>
double lower_end(const T* s) {
  if constexpr (Thresholded<F>) {
    return scalar(s[F::threshold]);
  } else {
    return F::positive ? 0 : -infinity;
  }
}

/// The scale on which the standard axis is linear: y or log y.
template <class F, class Y>
auto coordinate(const Y& y) {
  if constexpr (F::positive) {
    return log(y);
  } else {
    return y;
  }
}

/// The position of y on the standard axis.
template <class F, class Y, class T>
Result<Y, T> standard_place(const Y& y, const T* s) {
  if constexpr (Thresholded<F>) {
    return standard_place<typename F::Base>(y - s[F::threshold], s);
  } else {
    return F::z(coordinate<F>(y), s);
  }
}

/// y inside the support, here and below.
template <class F, class Y, class T>
Result<Y, T> log_density(const Y& y, const T* s) {
  if constexpr (Thresholded<F>) {
    return log_density<typename F::Base>(y - s[F::threshold], s);
  } else if constexpr (requires { F::log_density(y, s); }) {
    return F::log_density(y, s);
  } else {
    const auto u = coordinate<F>(y);
    return wearwell::log_density(F::standard, Result<Y, T>(F::z(u, s))) + F::log_rate(u, s);
  }
}

/// For an OnStandardAxis family, without slopes, which would double the cost; identical values.
inline double log_survival_there(StandardDistribution distribution, double z) {
  return log_survival_value(distribution, z);
}
template <int N>
Dual<N> log_survival_there(StandardDistribution distribution, const Dual<N>& z) {
  return wearwell::log_survival(distribution, z);
}
inline double log_cdf_there(StandardDistribution distribution, double z) {
  return log_cdf_value(distribution, z);
}
template <int N>
Dual<N> log_cdf_there(StandardDistribution distribution, const Dual<N>& z) {
  return wearwell::log_cdf(distribution, z);
}

template <class F, class Y, class T>
Result<Y, T> log_survival(const Y& y, const T* s) {
  if constexpr (Thresholded<F>) {
    return log_survival<typename F::Base>(y - s[F::threshold], s);
  } else if constexpr (OnStandardAxis<F>) {
    return log_survival_there(F::standard, standard_place<F>(y, s));
  } else {
    return F::log_survival(y, s);
  }
}

template <class F, class Y, class T>
Result<Y, T> log_cdf(const Y& y, const T* s) {
  if constexpr (Thresholded<F>) {
    return log_cdf<typename F::Base>(y - s[F::threshold], s);
  } else if constexpr (OnStandardAxis<F>) {
    return log_cdf_there(F::standard, standard_place<F>(y, s));
  } else {
    return F::log_cdf(y, s);
  }
}

/// The same probability is requested at very many points of a posterior.
inline double standard_quantile(StandardDistribution distribution, double p) {
  if (distribution != StandardDistribution::normal) return wearwell::quantile(distribution, p);
  static thread_local double last = 0.5, z = 0;
  if (p != last) {
    z = wearwell::quantile(distribution, p);
    last = p;
  }
  return z;
}

/// The y with P(Y <= y) = p, 0 < p < 1.
template <class F>
double quantile(double p, const double* s) {
  if constexpr (Thresholded<F>) {
    return s[F::threshold] + quantile<typename F::Base>(p, s);
  } else if constexpr (OnStandardAxis<F>) {
    return F::inverse(standard_quantile(F::standard, p), s);
  } else {
    return F::quantile(p, s);
  }
}

/// The y with P(Y > y) = q.
template <class F>
double upper_quantile(double q, const double* s) {
  if constexpr (Thresholded<F>) {
    return s[F::threshold] + upper_quantile<typename F::Base>(q, s);
  } else if constexpr (OnStandardAxis<F>) {
    return F::inverse(wearwell::upper_quantile(F::standard, q), s);
  } else {
    return positive_upper_quantile<F>(q, s, F::quantile(0.5, s));
  }
}

template <class F>
double mean(const double* s) {
  if constexpr (Thresholded<F>) {
    return s[F::threshold] + F::Base::mean(s);
  } else {
    return F::mean(s);
  }
}

}  // namespace wearwell::families
