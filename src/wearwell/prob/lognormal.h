#pragma once

#include <boost/math/distributions/lognormal.hpp>

#include "wearwell/math/boost_policy.h"
#include "wearwell/prob/family.h"
#include "wearwell/prob/normal_density.h"
#include "wearwell/prob/tails.h"

namespace wearwell::families {

/// log x is normal; `prepared` are its mean and standard deviation.
struct OfNormalLogarithm : OnPositive {
  static constexpr std::string_view name = "lognormal";
  static constexpr StandardDistribution standard = StandardDistribution::normal;
  static constexpr Paper paper = {"lognormal", StandardDistribution::normal};

  template <class X>
  static X log_kernel(const X& x, const double* c) {
    const X log_x = log(x);
    const X z = (log_x - c[0]) / c[1];
    return -0.5 * z * z - log_x;
  }
  static double log_integral(const double* c) { return 0.5 * log_two_pi + std::log(c[1]); }
  static auto tails(const double* c) {
    return Tails{boost::math::lognormal_distribution<double, Quiet>(0, c[1]), 0, std::exp(c[0])};
  }
};

struct Lognormal : OfNormalLogarithm {
  static constexpr auto family_parameters = std::to_array<ParameterForm>(
      {{"median", scale}, {"log_sd", number, false, "sd of the logarithm {}"}});
  static constexpr const char* c_density =
      "    const double z = (log(y) - log(a)) / b;\n"
      "    value = a > 0 && b > 0 && y > 0\n"
      "                ? -0.5 * z * z - log(b) - log(y) - 0.91893853320467274178\n"
      "                : -INFINITY;\n";

  template <class U, class T>
  static auto z(const U& log_y, const T* s) {
    return (log_y - log(s[0])) / s[1];
  }
  template <class U, class T>
  static auto log_rate(const U& log_y, const T* s) {
    return -log(s[1]) - log_y;
  }
  static double inverse(double z, const double* s) { return s[0] * std::exp(s[1] * z); }
  static double mean(const double* s) { return s[0] * std::exp(0.5 * s[1] * s[1]); }

  static double log_of_first(double median) { return std::log(median); }
  static double log_of_second(double log_sd) { return std::log(log_sd); }
  template <bool sloped>
  static Row row(double log_y, const double* s, const double* log_s) {
    const Row row = normal_row(log_y, log_s[0], s[1], log_s[1]);
    return {row.value - log_y, {row.slope[0] / s[0], row.slope[1]}};
  }
  static std::array<double, most_response_parameters> prepared(const double* s) {
    return {std::log(s[0]), s[1]};
  }
};

/// By mean and standard deviation of the quantity itself.
struct LognormalOfMoments : OfNormalLogarithm {
  static constexpr auto family_parameters =
      std::to_array<ParameterForm>({{"mean", scale}, {"sd", scale}});
  static constexpr const char* c_density =
      "    const double s2 = log1p((b / a) * (b / a)), s = sqrt(s2);\n"
      "    const double z = (log(y) - log(a) + 0.5 * s2) / s;\n"
      "    value = a > 0 && b > 0 && y > 0\n"
      "                ? -0.5 * z * z - log(s) - log(y) - 0.91893853320467274178\n"
      "                : -INFINITY;\n";

  template <class U, class T>
  static auto z(const U& log_y, const T* s) {
    const LognormalByMoments<T> distribution(s[0], s[1]);
    return (log_y - distribution.eta) / distribution.zeta;
  }
  template <class Y, class T>
  static auto log_density(const Y& y, const T* s) {
    const LognormalByMoments<T> distribution(s[0], s[1]);
    const auto log_y = log(y);
    const auto z = (log_y - distribution.eta) / distribution.zeta;
    return wearwell::log_density(standard, z) + (-log(distribution.zeta) - log_y);
  }
  static double inverse(double z, const double* s) {
    const double variance = std::log1p(s[1] / s[0] * (s[1] / s[0]));
    return s[0] * std::exp(std::sqrt(variance) * z - 0.5 * variance);
  }
  static double mean(const double* s) { return s[0]; }

  static std::array<double, most_response_parameters> prepared(const double* s) {
    const LognormalByMoments<double> distribution(s[0], s[1]);
    return {distribution.eta, distribution.zeta};
  }
};

/// By the median and the standard deviation of the decimal logarithm.
struct Log10Normal : OfNormalLogarithm {
  static constexpr std::string_view name = "log10-normal";
  static constexpr auto family_parameters = std::to_array<ParameterForm>(
      {{"median", scale}, {"log10_sd", number, false, "sd of the decimal logarithm {}"}});

  template <class U, class T>
  static auto z(const U& log_y, const T* s) {
    return (log_y - log(s[0])) / (ln10 * s[1]);
  }
  template <class U, class T>
  static auto log_rate(const U& log_y, const T* s) {
    return -log(ln10 * s[1]) - log_y;
  }
  static double inverse(double z, const double* s) { return s[0] * std::exp(ln10 * s[1] * z); }
  static double mean(const double* s) { return s[0] * std::exp(0.5 * ln10 * ln10 * s[1] * s[1]); }

  static double log_of_first(double median) { return std::log(median); }
  static double log_of_second(double log10_sd) { return std::log(ln10 * log10_sd); }
  template <bool sloped>
  static Row row(double log_y, const double* s, const double* log_s) {
    const Row row = normal_row(log_y, log_s[0], ln10 * s[1], log_s[1]);
    return {row.value - log_y, {row.slope[0] / s[0], ln10 * row.slope[1]}};
  }
  static std::array<double, most_response_parameters> prepared(const double* s) {
    return {std::log(s[0]), ln10 * s[1]};
  }
};

}  // namespace wearwell::families
