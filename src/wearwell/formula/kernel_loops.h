#pragma once

// The loops of all operations. Included by kernels.cpp for baseline vectors and by kernels_avx2.cpp
// for wider ones; everything is local to the including source.

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "wearwell/formula/kernels.h"
#include "wearwell/formula/operations.h"

namespace wearwell::formula {
namespace {

// Selects one of three arguments at compile time, so that a uniform argument is read once.
template <bool Uniform>
inline double get(const double* a, std::size_t i) {
  return a[Uniform ? 0 : i];
}

// Sums in eight lanes, in an order that does not depend on compiler or vector width.
template <class T>
inline double lane_sum(std::size_t n, const T& term) {
  double lane[8] = {};
  std::size_t i = 0;
  for (; i + 8 <= n; i += 8)
    for (std::size_t j = 0; j < 8; ++j) lane[j] += term(i + j);
  for (std::size_t j = 0; i < n; ++i, ++j) lane[j] += term(i);
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

// Adds term(i), or its sum, to the adjoint of an argument. A zero adjoint gives zero.
template <bool Uniform, class T>
inline void give(double* to, const double* __restrict g, std::size_t n, bool first,
                 const T& slope) {
  if (to == nullptr) return;
  const auto term = [&](std::size_t i) {
    const double product = g[i] * slope(i);
    return g[i] == 0 ? 0.0 : product;
  };
  if constexpr (Uniform) {
    *to += lane_sum(n, term);
  } else {
    double* __restrict out = to;
    if (first)
      for (std::size_t i = 0; i < n; ++i) out[i] = term(i);
    else
      for (std::size_t i = 0; i < n; ++i) out[i] += term(i);
  }
}

template <class F, bool A>
struct UnaryLoop {
  static void forward(const double* __restrict a, const double*, const double*,
                      double* __restrict y, std::size_t n, double) {
    for (std::size_t i = 0; i < n; ++i) y[i] = F::f(get<A>(a, i));
  }
  static void reverse(const double* a, const double*, const double*, const double* y,
                      const double* g, double* ga, double*, double*, std::size_t n, double,
                      unsigned first) {
    give<A>(ga, g, n, first & 1u, [=](std::size_t i) { return F::da(get<A>(a, i), y[i]); });
  }
};

template <class F, bool A, bool B>
struct BinaryLoop {
  static void forward(const double* a, const double* b, const double*, double* __restrict y,
                      std::size_t n, double) {
    for (std::size_t i = 0; i < n; ++i) y[i] = F::f(get<A>(a, i), get<B>(b, i));
  }
  static void reverse(const double* a, const double* b, const double*, const double* y,
                      const double* g, double* ga, double* gb, double*, std::size_t n, double,
                      unsigned first) {
    give<A>(ga, g, n, first & 1u,
            [=](std::size_t i) { return F::da(get<A>(a, i), get<B>(b, i), y[i]); });
    give<B>(gb, g, n, first & 2u,
            [=](std::size_t i) { return F::db(get<A>(a, i), get<B>(b, i), y[i]); });
  }
};

// a^extra by squaring. Small exponents are compile-time constants, so that their loops vectorize.
template <bool A>
struct WholePowerLoop {
  static double raise(double a, unsigned n) {
    double result = 1;
    for (; n > 0; n >>= 1, a *= a)
      if (n & 1u) result *= a;
    return result;
  }
  static double f(double a, int n) {
    const double y = raise(a, static_cast<unsigned>(n < 0 ? -n : n));
    return n < 0 ? 1 / y : y;
  }
  template <class Loop>
  static void with_exponent(double extra, const Loop& loop) {
    const int n = static_cast<int>(extra);
    switch (n) {
      case -2:
        return loop(std::integral_constant<int, -2>());
      case -1:
        return loop(std::integral_constant<int, -1>());
      case 2:
        return loop(std::integral_constant<int, 2>());
      case 3:
        return loop(std::integral_constant<int, 3>());
      case 4:
        return loop(std::integral_constant<int, 4>());
      default:
        return loop(n);
    }
  }
  static void forward(const double* __restrict a, const double*, const double*,
                      double* __restrict y, std::size_t n, double extra) {
    with_exponent(extra, [=](auto exponent) {
      for (std::size_t i = 0; i < n; ++i) y[i] = f(get<A>(a, i), exponent);
    });
  }
  static void reverse(const double* a, const double*, const double*, const double*, const double* g,
                      double* ga, double*, double*, std::size_t n, double extra, unsigned first) {
    with_exponent(extra, [=](auto exponent) {
      give<A>(ga, g, n, first & 1u, [=](std::size_t i) {
        return static_cast<double>(exponent) * f(get<A>(a, i), exponent - 1);
      });
    });
  }
};

// a^b with known c = log a; a and c do not depend on parameters.
template <bool A, bool B, bool C>
struct PowerLogLoop {
  static void forward(const double*, const double* __restrict b, const double* __restrict c,
                      double* __restrict y, std::size_t n, double) {
    for (std::size_t i = 0; i < n; ++i) y[i] = powered(get<B>(b, i), get<C>(c, i));
  }
  static void reverse(const double*, const double* b, const double* c, const double* y,
                      const double* g, double*, double* gb, double*, std::size_t n, double,
                      unsigned first) {
    give<B>(gb, g, n, first & 2u,
            [=](std::size_t i) { return power_by_exponent(get<B>(b, i), y[i], get<C>(c, i)); });
  }
};

template <bool A, bool B, bool C>
struct WhereLoop {
  static void forward(const double* a, const double* b, const double* c, double* __restrict y,
                      std::size_t n, double) {
    for (std::size_t i = 0; i < n; ++i) {
      const double yes = get<B>(b, i), no = get<C>(c, i);
      y[i] = get<A>(a, i) != 0 ? yes : no;
    }
  }
  static void reverse(const double* a, const double*, const double*, const double*, const double* g,
                      double*, double* gb, double* gc, std::size_t n, double, unsigned first) {
    give<B>(gb, g, n, first & 2u, [=](std::size_t i) { return get<A>(a, i) != 0 ? 1.0 : 0.0; });
    give<C>(gc, g, n, first & 4u, [=](std::size_t i) { return get<A>(a, i) != 0 ? 0.0 : 1.0; });
  }
};

template <class Loop>
Kernels kernels_in() {
  return {Loop::forward, Loop::reverse};
}

template <class F>
Kernels unary(unsigned uniform) {
  return uniform & 1u ? kernels_in<UnaryLoop<F, true>>() : kernels_in<UnaryLoop<F, false>>();
}

template <class F>
Kernels binary(unsigned uniform) {
  switch (uniform & 3u) {
    case 0:
      return kernels_in<BinaryLoop<F, false, false>>();
    case 1:
      return kernels_in<BinaryLoop<F, true, false>>();
    case 2:
      return kernels_in<BinaryLoop<F, false, true>>();
    default:
      return kernels_in<BinaryLoop<F, true, true>>();
  }
}

template <template <bool, bool, bool> class Loop>
Kernels ternary(unsigned uniform) {
  switch (uniform & 7u) {
    case 0:
      return kernels_in<Loop<false, false, false>>();
    case 1:
      return kernels_in<Loop<true, false, false>>();
    case 2:
      return kernels_in<Loop<false, true, false>>();
    case 3:
      return kernels_in<Loop<true, true, false>>();
    case 4:
      return kernels_in<Loop<false, false, true>>();
    case 5:
      return kernels_in<Loop<true, false, true>>();
    case 6:
      return kernels_in<Loop<false, true, true>>();
    default:
      return kernels_in<Loop<true, true, true>>();
  }
}

[[maybe_unused]] Kernels local_kernels(Op op, unsigned uniform) {
  switch (op) {
    case Op::add:
      return binary<Add>(uniform);
    case Op::subtract:
      return binary<Subtract>(uniform);
    case Op::multiply:
      return binary<Multiply>(uniform);
    case Op::divide:
      return binary<Divide>(uniform);
    case Op::negate:
      return unary<Negate>(uniform);
    case Op::power:
      return binary<Power>(uniform);
    case Op::whole_power:
      return uniform & 1u ? kernels_in<WholePowerLoop<true>>()
                          : kernels_in<WholePowerLoop<false>>();
    case Op::power_log:
      return ternary<PowerLogLoop>(uniform);
    case Op::exp:
      return unary<Exp>(uniform);
    case Op::log:
      return unary<Log>(uniform);
    case Op::log10:
      return unary<Log10>(uniform);
    case Op::sqrt:
      return unary<Sqrt>(uniform);
    case Op::abs:
      return unary<Abs>(uniform);
    case Op::min:
      return binary<Min>(uniform);
    case Op::max:
      return binary<Max>(uniform);
    case Op::erf:
      return unary<Erf>(uniform);
    case Op::erfc:
      return unary<Erfc>(uniform);
    case Op::probit:
      return unary<Probit>(uniform);
    case Op::gamma:
      return unary<Gamma>(uniform);
    case Op::lgamma:
      return unary<LogGamma>(uniform);
    case Op::digamma:
      return unary<Digamma>(uniform);
    case Op::tanh:
      return unary<Tanh>(uniform);
    case Op::sin:
      return unary<Sin>(uniform);
    case Op::cos:
      return unary<Cos>(uniform);
    case Op::atan:
      return unary<Atan>(uniform);
    case Op::log1p:
      return unary<Log1p>(uniform);
    case Op::expm1:
      return unary<Expm1>(uniform);
    case Op::growth:
      return unary<Growth>(uniform);
    case Op::gamma_cdf:
      return binary<GammaCdf>(uniform);
    case Op::gamma_survival:
      return binary<GammaSurvival>(uniform);
    case Op::gamma_quantile:
      return binary<GammaQuantile>(uniform);
    case Op::inverse_gaussian_cdf:
      return binary<InverseGaussianCdf>(uniform);
    case Op::inverse_gaussian_survival:
      return binary<InverseGaussianSurvival>(uniform);
    case Op::inverse_gaussian_quantile:
      return binary<InverseGaussianQuantile>(uniform);
    case Op::generalized_gamma_cdf:
      return binary<GeneralizedGammaCdf>(uniform);
    case Op::generalized_gamma_pdf:
      return binary<GeneralizedGammaPdf>(uniform);
    case Op::generalized_gamma_quantile:
      return binary<GeneralizedGammaQuantile>(uniform);
    case Op::student_t_cdf:
      return binary<StudentTCdf>(uniform);
    case Op::student_t_quantile:
      return binary<StudentTQuantile>(uniform);
    case Op::less:
      return binary<Less>(uniform);
    case Op::less_equal:
      return binary<LessEqual>(uniform);
    case Op::equal:
      return binary<Equal>(uniform);
    case Op::unequal:
      return binary<Unequal>(uniform);
    case Op::both:
      return binary<Both>(uniform);
    case Op::either:
      return binary<Either>(uniform);
    case Op::opposite:
      return unary<Opposite>(uniform);
    case Op::where:
      return ternary<WhereLoop>(uniform);
    default:
      return {};
  }
}

}  // namespace
}  // namespace wearwell::formula
