#pragma once

#include "wearwell/prob/family.h"
#include "wearwell/prob/log_sums.h"
#include "wearwell/prob/quantile_root.h"

namespace wearwell::families {

/// By mean and shape: Chhikara and Folks (1989), ch. 2.
struct InverseGaussian : OnPositive {
  static constexpr std::string_view name = "inverse-gaussian";
  static constexpr std::string_view title = "inverse Gaussian";
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"mean", scale}, {"shape", scale}});

  template <class Y, class T>
  static auto log_density(const Y& y, const T* s) {
    const auto off = (y - s[0]) / s[0];
    return 0.5 * (log(s[1]) - std::log(2 * M_PI) - 3.0 * log(y)) - s[1] * off * off / (2.0 * y);
  }
  template <class Y, class T>
  static auto log_cdf(const Y& y, const T* s) {
    using R = Result<Y, T>;
    const Arguments<R> at(y, s);
    const R first = wearwell::log_cdf(StandardDistribution::normal, at.a),
            second = at.log_mirrored();
    return scalar(first) > scalar(second) ? R(first + log1p(exp(second - first)))
                                          : R(second + log1p(exp(first - second)));
  }
  template <class Y, class T>
  static auto log_survival(const Y& y, const T* s) {
    using R = Result<Y, T>;
    const Arguments<R> at(y, s);
    return log_difference(wearwell::log_survival(StandardDistribution::normal, at.a),
                          at.log_mirrored());
  }
  static double quantile(double p, const double* s) {
    return positive_quantile<InverseGaussian>(p, s, mean(s));
  }
  static double mean(const double* s) { return s[0]; }

 private:
  // P(Y <= y) = Phi(a) + e^power Phi(-b).
  template <class R>
  struct Arguments {
    R a, b, power;

    template <class Y, class T>
    Arguments(const Y& y, const T* s) {
      const R root = sqrt(s[1] / y);
      a = root * (y / s[0] - 1.0);
      b = root * (y / s[0] + 1.0);
      power = 2.0 * s[1] / s[0];
    }
    R log_mirrored() const {
      return power + wearwell::log_cdf(StandardDistribution::normal, R(-b));
    }
  };
};

}  // namespace wearwell::families
