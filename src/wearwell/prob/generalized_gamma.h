#pragma once

#include <boost/math/special_functions/log1p.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/prob/family.h"
#include "wearwell/prob/gamma_tail.h"
#include "wearwell/prob/quantile_root.h"

namespace wearwell::families {

namespace generalized {

// (e^u - 1 - u)/u^2, and its limit 1/2.
template <class R>
R curvature(const R& u) {
  if (std::abs(scalar(u)) > 0.5) return (expm1(u) - u) / (u * u);
  R sum(0.0);
  for (int k = 14; k >= 0; --k) sum = (1.0 + u * sum) / (k + 2.0);
  return sum;
}

// The remainder of Stirling's formula for log Gamma(1/w), w > 0, with its derivative; 0 at w = 0.
// The last one is kept: all rows of a likelihood have the same w.
inline ValueAndSlope stirling_rest_and_slope(double w) {
  if (!(w > 0.1)) {
    constexpr double c[] = {1. / 12, -1. / 360, 1. / 1260, -1. / 1680, 1. / 1188, -691. / 360360};
    ValueAndSlope rest;
    for (int k = 5; k >= 0; --k) {
      rest.value = c[k] + w * w * rest.value;
      rest.slope = (2 * k + 1) * c[k] + w * w * rest.slope;
    }
    return {w * rest.value, rest.slope};
  }
  thread_local double last = 0;
  thread_local ValueAndSlope rest;
  if (w != last) {
    const double a = 1 / w;
    rest = {boost::math::lgamma(a, Quiet()) - (a - 0.5) * std::log(a) + a - half_log_two_pi,
            -a * a * (digamma<Quiet>(a) - std::log(a) + 0.5 * w)};
    last = w;
  }
  return rest;
}
template <class R>
R stirling_rest(const R& w) {
  const ValueAndSlope rest = stirling_rest_and_slope(scalar(w));
  return chained(w, rest.value, rest.slope);
}

// Temme's expansion of the incomplete gamma functions for large a = 1/w at eta (DLMF 8.12.7 to
// 8.12.10): their difference from the normal distribution, divided by its density and sqrt(w).
template <class R>
R temme_sum(const R& eta, const R& w) {
  static constexpr double c[4][15] = {
      {-0.33333333333333333, 0.083333333333333333, -0.014814814814814815, 0.0011574074074074074,
       0.0003527336860670194, -0.00017875514403292181, 0.39192631785224378e-4,
       -0.21854485106799922e-5, -0.185406221071516e-5, 0.8296711340953086e-6,
       -0.17665952736826079e-6, 0.67078535434014986e-8, 0.10261809784240308e-7,
       -0.43820360184533532e-8, 0.91476995822367902e-9},
      {-0.0018518518518518519, -0.0034722222222222222, 0.0026455026455026455,
       -0.00099022633744855967, 0.00020576131687242798, -0.40187757201646091e-6,
       -0.18098550334489978e-4, 0.76491609160811101e-5, -0.16120900894563446e-5,
       0.46471278028074343e-8, 0.1378633446915721e-6, -0.5752545603517705e-7},
      {0.0041335978835978836, -0.0026813271604938272, 0.00077160493827160494,
       0.20093878600823045e-5, -0.00010736653226365161, 0.52923448829120125e-4,
       -0.12760635188618728e-4, 0.34235787340961381e-7},
      {0.00064943415637860082, 0.00022947209362139918, -0.00046918949439525571,
       0.00026772063206283885, -0.75618016718839764e-4}};
  R all(0.0);
  for (int k = 3; k >= 0; --k) {
    R sum(0.0);
    for (int i = 14; i >= 0; --i) sum = c[k][i] + eta * sum;
    all = sum + w * all;
  }
  return all;
}

}  // namespace generalized

/// The extended generalized gamma distribution of Meeker and Escobar (1998, sec. 5.4; Prentice
/// 1974): of omega = log(y/scale)/sigma the density is |lambda| exp(kappa (u - e^u) + kappa log
/// kappa)/Gamma(kappa), u = lambda omega, kappa = 1/lambda^2. lambda = 1 is the Weibull
/// distribution of shape 1/sigma, lambda = 0 the lognormal, lambda = -1 the Frechet, lambda = sigma
/// the gamma distribution of shape 1/sigma^2 and mean `scale`.
struct GeneralizedGamma : OnPositive {
  static constexpr std::string_view name = "generalized-gamma";
  static constexpr std::string_view title = "generalized gamma";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"scale", scale}, {"sigma", number}, {"lambda", real}});

  template <class Y, class T>
  static auto log_density(const Y& y, const T* s) {
    using R = Result<Y, T>;
    const auto log_y = log(y);
    return At<R>(log_y, s).log_density - log(s[1]) - log_y;
  }
  template <class Y, class T>
  static auto log_survival(const Y& y, const T* s) {
    return At<Result<Y, T>>(log(y), s).log_tail(true);
  }
  template <class Y, class T>
  static auto log_cdf(const Y& y, const T* s) {
    return At<Result<Y, T>>(log(y), s).log_tail(false);
  }
  static double quantile(double p, const double* s) {
    return positive_quantile<GeneralizedGamma>(p, s, near_quantile(p, s));
  }
  static double mean(const double* s) {
    const double sigma = s[1], lambda = s[2];
    if (lambda < 0 && !(-lambda * sigma < 1)) return quantile(0.5, s);
    if (std::abs(lambda) < 1e-100) return s[0] * std::exp(0.5 * sigma * sigma);
    // The logarithm of Gamma(kappa + delta)/Gamma(kappa) kappa^-delta by Stirling's formula with
    // remainder.
    const double kappa = 1 / (lambda * lambda), grown = 1 + sigma * lambda;
    return s[0] * std::exp(kappa * boost::math::log1pmx(sigma * lambda, Quiet()) +
                           (sigma / lambda - 0.5) * std::log1p(sigma * lambda) +
                           generalized::stirling_rest(1 / (kappa * grown)) -
                           generalized::stirling_rest(1 / kappa));
  }

 private:
  // By Wilson and Hilferty's (1931) cube root, or by the first term of the series.
  static double near_quantile(double p, const double* s) {
    const double lambda = s[2], z = wearwell::quantile(StandardDistribution::normal, p);
    double omega = z;
    if (std::abs(lambda) > 1e-100) {
      const double kappa = 1 / (lambda * lambda), cube_root = 1 + lambda * (z / 3 - lambda / 9);
      const double log_p = lambda > 0 ? std::log(p) : std::log1p(-p);
      omega = (cube_root > 0.3
                   ? 3 * std::log1p(cube_root - 1)
                   : (log_p + boost::math::lgamma(kappa + 1, Quiet())) / kappa - std::log(kappa)) /
              lambda;
    }
    const double y = s[0] * std::exp(s[1] * omega);
    return y > 1e-300 && y < 1e300 ? y : s[0];
  }

  template <class R>
  struct At {
    R lambda, omega, u, half_square;  // half_square = kappa (e^u - 1 - u)
    R log_density;                    // of omega

    template <class U, class T>
    At(const U& log_y, const T* s) : lambda(s[2]) {
      omega = (log_y - log(s[0])) / s[1];
      u = lambda * omega;
      half_square = omega * omega * generalized::curvature(u);
      log_density = -half_square - half_log_two_pi - generalized::stirling_rest(R(lambda * lambda));
    }

    R log_tail(bool upper) const {
      if (std::abs(scalar(lambda)) < 0.05 && std::abs(scalar(u)) < 0.3) return near_normal(upper);
      const bool of_gamma_upper = upper == (scalar(lambda) > 0);
      if (scalar(u) > 0 && !(scalar(half_square) < infinity))
        return of_gamma_upper ? R(-infinity) : R(0.0);
      const R kappa = 1.0 / (lambda * lambda), x = kappa * exp(u);
      const R log_kernel = log_density + 0.5 * log(kappa);  // of x^kappa e^-x/Gamma(kappa)
      return of_gamma_upper ? log_gamma_upper(kappa, x, log_kernel)
                            : log_gamma_lower(kappa, x, log_kernel);
    }

    R near_normal(bool upper) const {
      const R z = omega * sqrt(2.0 * generalized::curvature(u));
      const R sum = lambda * generalized::temme_sum(R(lambda * z), R(lambda * lambda));
      const R tail = upper ? wearwell::log_survival(StandardDistribution::normal, z)
                           : wearwell::log_cdf(StandardDistribution::normal, z);
      const R ratio = exp(wearwell::log_density(StandardDistribution::normal, z) - tail);
      return tail + log1p(upper ? R(sum * ratio) : R(-sum * ratio));
    }
  };
};

}  // namespace wearwell::families
