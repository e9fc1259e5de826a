#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wearwell/prob/log_sums.h"
#include "wearwell/prob/weibull.h"

namespace wearwell::families {

/// P(Y <= y) = (1 - exp(-(y/scale)^shape))^exponent (Mudholkar and Srivastava 1993): the maximum of
/// `exponent` Weibull lives if that is a whole number. Its hazard can have a bathtub shape.
struct ExponentiatedWeibull : OnPositive {
  static constexpr std::string_view name = "exponentiated-weibull";
  static constexpr std::string_view title = "exponentiated Weibull";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"scale", scale}, {"shape", number}, {"exponent", number}});
  static constexpr Paper paper = {"Weibull", StandardDistribution::smallest_extreme_value, false};

  template <class Y, class T>
  static auto log_density(const Y& y, const T* s) {
    const auto log_y = log(y);
    const auto z = Weibull::z(log_y, s);
    return log(s[2]) + (s[2] - 1.0) * wearwell::log_cdf(Weibull::standard, z) +
           wearwell::log_density(Weibull::standard, z) + Weibull::log_rate(log_y, s);
  }
  template <class Y, class T>
  static auto log_cdf(const Y& y, const T* s) {
    return s[2] * wearwell::log_cdf(Weibull::standard, Weibull::z(log(y), s));
  }
  template <class Y, class T>
  static auto log_survival(const Y& y, const T* s) {
    using R = Result<Y, T>;
    const R z = Weibull::z(log(y), s);
    // Where the Weibull survival S is below 1e-17, 1 - (1 - S)^exponent is 1 - exp(-exponent S).
    if (scalar(z) > 3.7) {
      const R log_rate = log(s[2]) + wearwell::log_survival(Weibull::standard, z);
      return scalar(log_rate) < -37 ? log_rate : R(log_rest(R(-exp(log_rate))));
    }
    return R(log_rest(R(s[2] * wearwell::log_cdf(Weibull::standard, z))));
  }
  static double quantile(double p, const double* s) { return quantile_at(std::log(p) / s[2], s); }
  // Of e^(u/shape), u = shape log(y/scale), by the trapezoidal rule, which converges exponentially:
  // nodes halfway between are added until they change nothing.
  static double mean(const double* s) {
    const double middle = std::log(-log_rest(-std::numbers::ln2 / s[2]));  // the median of u
    double step = 0.4, sum = sum_about(middle, step, s), change = 0;
    do {
      change = 0.5 * (sum_about(middle + 0.5 * step, step, s) - sum);
      sum += change;
      step /= 2;
    } while (std::abs(change) > 1e-7 * sum && step > 1e-4);
    return s[0] * sum;
  }

 private:
  // The density of u times e^(u/shape) is log-concave in u: from the middle to both sides until it is negligible.
  static double sum_about(double middle, double step, const double* s) {
    constexpr double negligible = 1e-17;
    const auto term = [&](double u) {
      const double hazard = std::exp(u), log_cdf = u < -30 ? u : std::log(-std::expm1(-hazard));
      return std::exp((s[2] - 1) * log_cdf - hazard + u + u / s[1]);
    };
    double sum = term(middle), largest = sum;
    for (const int way : {-1, 1}) {
      for (int i = 1;; ++i) {
        const double here = term(middle + way * i * step);
        sum += here;
        if (!(here > negligible * largest)) break;
        largest = std::max(largest, here);
      }
    }
    return s[2] * step * sum;
  }
  // The Weibull quantile of exp(log_p).
  static double quantile_at(double log_p, const double* s) {
    const double z = log_p < -37 ? log_p : std::log(-log_rest(log_p));
    return Weibull::inverse(z, s);
  }
};

}  // namespace wearwell::families
