#pragma once

// Each operation on numbers, with its derivatives. Like vector_math.h, local to the including
// source.

#include <cmath>
#include <limits>

#include "wearwell/formula/distribution_functions.h"
#include "wearwell/formula/special_functions.h"
#include "wearwell/formula/vector_math.h"

namespace wearwell::formula {
namespace {

inline double sign_of(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

// Functions of one argument: value, and slope from argument and value. expm1(x)/x and its slope use
// their series where the formula would cancel.
inline double growth(double x) {
  return x == 0 ? 1 : std::expm1(x) / x;
}
inline double growth_slope(double x, double y) {
  if (std::abs(x) >= 0.5) return (y * x + 1 - y) / x;
  double sum = 0, factorial = 355687428096000;  // 17!
  for (int k = 15; k >= 0; --k) {               // of (k + 1) x^k / (k + 2)!
    sum = sum * x + (k + 1) / factorial;
    factorial /= k + 2;
  }
  return sum;
}

#define WEARWELL_UNARY(Name, VALUE, SLOPE)                                                   \
  struct Name {                                                                              \
    static double f([[maybe_unused]] double a) { return VALUE; }                             \
    static double da([[maybe_unused]] double a, [[maybe_unused]] double y) { return SLOPE; } \
  };
WEARWELL_UNARY(Negate, -a, -1)
WEARWELL_UNARY(Exp, vector_exp(a), y)
WEARWELL_UNARY(Log, vector_log(a), 1 / a)
WEARWELL_UNARY(Log10, std::log10(a), 0.43429448190325182765 / a)
WEARWELL_UNARY(Sqrt, std::sqrt(a), 0.5 / y)
WEARWELL_UNARY(Abs, std::abs(a), sign_of(a))
WEARWELL_UNARY(Erf, std::erf(a), 1.1283791670955125739 * vector_exp(-a * a))
WEARWELL_UNARY(Erfc, std::erfc(a), -1.1283791670955125739 * vector_exp(-a * a))
WEARWELL_UNARY(Probit, probit(a), 2.5066282746310005024 * vector_exp(0.5 * y * y))
WEARWELL_UNARY(Gamma, gamma_function(a), y* digamma(a))
WEARWELL_UNARY(LogGamma, log_gamma(a), digamma(a))
WEARWELL_UNARY(Digamma, digamma(a), trigamma(a))
WEARWELL_UNARY(Tanh, std::tanh(a), 1 - y * y)
WEARWELL_UNARY(Sin, std::sin(a), std::cos(a))
WEARWELL_UNARY(Cos, std::cos(a), -std::sin(a))
WEARWELL_UNARY(Atan, std::atan(a), 1 / (1 + a * a))
WEARWELL_UNARY(Log1p, std::log1p(a), 1 / (1 + a))
WEARWELL_UNARY(Expm1, std::expm1(a), 1 + y)
WEARWELL_UNARY(Growth, growth(a), growth_slope(a, y))
WEARWELL_UNARY(Opposite, a != 0 ? 0.0 : 1.0, 0)
#undef WEARWELL_UNARY

#define WEARWELL_BINARY(Name, VALUE, BY_A, BY_B)                                            \
  struct Name {                                                                             \
    static double f([[maybe_unused]] double a, [[maybe_unused]] double b) { return VALUE; } \
    static double da([[maybe_unused]] double a, [[maybe_unused]] double b,                  \
                     [[maybe_unused]] double y) {                                           \
      return BY_A;                                                                          \
    }                                                                                       \
    static double db([[maybe_unused]] double a, [[maybe_unused]] double b,                  \
                     [[maybe_unused]] double y) {                                           \
      return BY_B;                                                                          \
    }                                                                                       \
  };
WEARWELL_BINARY(Add, a + b, 1, 1)
WEARWELL_BINARY(Subtract, a - b, 1, -1)
WEARWELL_BINARY(Multiply, a* b, b, a)
WEARWELL_BINARY(Divide, a / b, 1 / b, -y / b)
// NaN propagates.
WEARWELL_BINARY(Min, (a < b || a != a) ? a : b, a < b ? 1.0 : 0.0, a < b ? 0.0 : 1.0)
WEARWELL_BINARY(Max, (a > b || a != a) ? a : b, a > b ? 1.0 : 0.0, a > b ? 0.0 : 1.0)
WEARWELL_BINARY(Less, a < b ? 1.0 : 0.0, 0, 0)
WEARWELL_BINARY(LessEqual, a <= b ? 1.0 : 0.0, 0, 0)
WEARWELL_BINARY(Equal, a == b ? 1.0 : 0.0, 0, 0)
WEARWELL_BINARY(Unequal, a != b ? 1.0 : 0.0, 0, 0)
WEARWELL_BINARY(Both, (a != 0 && b != 0) ? 1.0 : 0.0, 0, 0)
WEARWELL_BINARY(Either, (a != 0 || b != 0) ? 1.0 : 0.0, 0, 0)
WEARWELL_BINARY(GammaCdf, standard_cdf(Standard::gamma, a, b), standard_pdf(Standard::gamma, a, b),
                cdf_slope(Standard::gamma, a, b))
WEARWELL_BINARY(GammaSurvival, standard_survival(Standard::gamma, a, b),
                -standard_pdf(Standard::gamma, a, b), survival_slope(Standard::gamma, a, b))
WEARWELL_BINARY(GammaQuantile, standard_quantile(Standard::gamma, a, b),
                1 / standard_pdf(Standard::gamma, y, b), quantile_slope(Standard::gamma, y, b))
WEARWELL_BINARY(InverseGaussianCdf, standard_cdf(Standard::inverse_gaussian, a, b),
                standard_pdf(Standard::inverse_gaussian, a, b),
                cdf_slope(Standard::inverse_gaussian, a, b))
WEARWELL_BINARY(InverseGaussianSurvival, standard_survival(Standard::inverse_gaussian, a, b),
                -standard_pdf(Standard::inverse_gaussian, a, b),
                survival_slope(Standard::inverse_gaussian, a, b))
WEARWELL_BINARY(InverseGaussianQuantile, standard_quantile(Standard::inverse_gaussian, a, b),
                1 / standard_pdf(Standard::inverse_gaussian, y, b),
                quantile_slope(Standard::inverse_gaussian, y, b))
WEARWELL_BINARY(GeneralizedGammaCdf, standard_cdf(Standard::generalized_gamma, a, b),
                standard_pdf(Standard::generalized_gamma, a, b),
                cdf_slope(Standard::generalized_gamma, a, b))
WEARWELL_BINARY(GeneralizedGammaPdf, standard_pdf(Standard::generalized_gamma, a, b),
                pdf_slope_by_x(Standard::generalized_gamma, a, b),
                pdf_slope(Standard::generalized_gamma, a, b))
WEARWELL_BINARY(GeneralizedGammaQuantile, standard_quantile(Standard::generalized_gamma, a, b),
                1 / standard_pdf(Standard::generalized_gamma, y, b),
                quantile_slope(Standard::generalized_gamma, y, b))
WEARWELL_BINARY(StudentTCdf, standard_cdf(Standard::student_t, a, b),
                standard_pdf(Standard::student_t, a, b), cdf_slope(Standard::student_t, a, b))
WEARWELL_BINARY(StudentTQuantile, standard_quantile(Standard::student_t, a, b),
                1 / standard_pdf(Standard::student_t, y, b),
                quantile_slope(Standard::student_t, y, b))
#undef WEARWELL_BINARY

// a^b of a >= 0, given log a. NaN for a < 0 except for b = 0, because the exponent is not a fixed
// whole number.
inline double powered(double b, double log_a) {
  const double y = vector_exp(b * log_a);
  return b == 0 ? 1 : y;
}
inline double power_by_base(double a, double b, double y) {
  const double at_zero = b == 1 ? 1 : b > 1 || b == 0 ? 0 : std::numeric_limits<double>::infinity();
  return a == 0 ? at_zero : b * y / a;
}
inline double power_by_exponent(double b, double y, double log_a) {
  return y == 0 && b > 0 ? 0 : y * log_a;
}

struct Power {
  static double f(double a, double b) { return powered(b, vector_log(a)); }
  static double da(double a, double b, double y) { return power_by_base(a, b, y); }
  static double db(double a, double b, double y) { return power_by_exponent(b, y, vector_log(a)); }
};

}  // namespace
}  // namespace wearwell::formula
