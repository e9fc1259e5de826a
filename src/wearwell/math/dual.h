#pragma once

#include <ceres/jet.h>

#include <span>
#include <stdexcept>

namespace wearwell {

/// A value with its derivatives by N variables, for forward automatic differentiation: a formula
/// written once as a template over its scalar gives both.
template <int N>
using Dual = ceres::Jet<double, N>;

/// The value alone.
inline double scalar(double x) {
  return x;
}
template <int N>
double scalar(const Dual<N>& x) {
  return x.a;
}

/// g(x) by the chain rule, where the value of g at x and its derivative `slope` there are known:
/// special functions enter formulas this way.
inline double chained(double, double value, double) {
  return value;
}
template <int N>
Dual<N> chained(const Dual<N>& x, double value, double slope) {
  return Dual<N>(value, slope * x.v);
}

/// The value of `f` at `x` and, in `gradient`, its derivatives; `x` and `gradient` have 1 to MaxN
/// entries each. `f` takes `const T* x` for T = double and Dual<N>, an array of always MaxN entries,
/// of which those beyond x.size() are 0. Nothing is allocated. Throws std::logic_error for an empty
/// `x`, and what `f` throws.
template <int MaxN, int N = MaxN, class F>
double value_and_gradient(const F& f, std::span<const double> x, std::span<double> gradient) {
  if constexpr (N == 0) {
    throw std::logic_error("value_and_gradient: no variables");
  } else if (x.size() < N) {
    return value_and_gradient<MaxN, N - 1>(f, x, gradient);
  } else {
    Dual<N> seeded[MaxN];
    for (int i = 0; i < N; ++i) seeded[i] = Dual<N>(x[i], i);
    const Dual<N> y = f(static_cast<const Dual<N>*>(seeded));
    for (int i = 0; i < N; ++i) gradient[i] = y.v[i];
    return y.a;
  }
}

}  // namespace wearwell
