#include "wearwell/math/normality.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/tools/rational.hpp>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

constexpr int lilliefors_samples = 10'000;

double normal_cdf(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

/// For values in ascending order.
double distance(const std::vector<double>& sorted, double mean, double sd) {
  const double n = static_cast<double>(sorted.size());
  double most = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double p = normal_cdf((sorted[i] - mean) / sd), below = static_cast<double>(i) / n;
    most = std::max({most, p - below, below + 1 / n - p});
  }
  return most;
}

double standardized_distance(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const Eigen::Map<const Eigen::ArrayXd> x(values.data(), std::ssize(values));
  const double mean = x.mean();
  const double sd = std::sqrt((x - mean).square().sum() / static_cast<double>(x.size() - 1));
  return distance(values, mean, sd);
}

// Spreads equal values over the middle half of the gaps beside them; ascending.
void spread_ties(std::vector<double>& sorted) {
  const std::vector<double> at = sorted;
  for (std::size_t i = 0; i < at.size();) {
    std::size_t end = i + 1;
    while (end < at.size() && at[end] == at[i]) ++end;
    if (end - i > 1 && end - i < at.size()) {
      const double before = i > 0 ? at[i] - at[i - 1] : at[end] - at[i];
      const double after = end < at.size() ? at[end] - at[i] : before;
      const double low = at[i] - 0.5 * before, width = 0.5 * (before + after);
      for (std::size_t j = i; j < end; ++j) {
        sorted[j] = low + width * (static_cast<double>(j - i) + 0.5) / static_cast<double>(end - i);
      }
    }
    i = end;
  }
}

// The p value of A^2 with estimated mean and standard deviation, modified for n.
double anderson_darling_p(double a) {
  constexpr double largest = 100;  // beyond it the parabola for the logarithm increases again
  a = std::min(a, largest);
  if (a >= 0.6) return std::exp(1.2937 - 5.709 * a + 0.0186 * a * a);
  if (a >= 0.34) return std::exp(0.9177 - 4.279 * a - 1.38 * a * a);
  if (a >= 0.2) return 1 - std::exp(-8.318 + 42.796 * a - 59.938 * a * a);
  return 1 - std::exp(-13.436 + 101.14 * a - 223.73 * a * a);
}

// The expected order statistic i of n, by Blom's approximation.
double expected_order_statistic(std::size_t i, std::size_t n) {
  const double p = (static_cast<double>(i) + 0.625) / (static_cast<double>(n) + 0.25);
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p);
}

double polynomial(std::initializer_list<double> coefficients, double x) {
  return boost::math::tools::evaluate_polynomial(coefficients.begin(), x, coefficients.size());
}

// Coefficients of the upper half of the order statistics in W, from the largest on; those of the
// lower half are their negatives.
std::vector<double> shapiro_wilk_coefficients(std::size_t n) {
  std::vector<double> a(n / 2);
  double square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = -expected_order_statistic(i, n);
    square += 2 * a[i] * a[i];
  }
  const double length = std::sqrt(square), u = 1 / std::sqrt(static_cast<double>(n));
  const double first =
      a[0] / length + polynomial({0, 0.221157, -0.147981, -2.07119, 4.434685, -2.706056}, u);
  std::size_t corrected = 1;
  double rest = square - 2 * a[0] * a[0], share = 1 - 2 * first * first;
  if (n > 5) {
    const double second =
        a[1] / length + polynomial({0, 0.042981, -0.293762, -1.752461, 5.682633, -3.582633}, u);
    rest -= 2 * a[1] * a[1];
    share -= 2 * second * second;
    a[1] = second;
    corrected = 2;
  }
  a[0] = first;
  for (std::size_t i = corrected; i < a.size(); ++i) a[i] /= std::sqrt(rest / share);
  return a;
}

// The logarithm of 1 - W as a standard normal score.
double shapiro_wilk_score(double one_less_w, double n) {
  double y = std::log(one_less_w), mean = 0, sd = 0;
  if (n < 12) {
    const double most = polynomial({-2.273, 0.459}, n);
    if (y >= most) return std::numeric_limits<double>::infinity();
    y = -std::log(most - y);
    mean = polynomial({0.544, -0.39978, 0.025054, -0.0006714}, n);
    sd = std::exp(polynomial({1.3822, -0.77857, 0.062767, -0.0020322}, n));
  } else {
    const double x = std::log(n);
    mean = polynomial({-1.5861, -0.31082, -0.083751, 0.0038915}, x);
    sd = std::exp(polynomial({-0.4803, -0.082676, 0.0030302}, x));
  }
  return (y - mean) / sd;
}

/// A matrix times 10^exponent, so that its powers do not overflow.
struct Scaled {
  Eigen::MatrixXd matrix;
  int exponent = 0;

  Scaled times(const Scaled& other) const {
    Scaled product{matrix * other.matrix, exponent + other.exponent};
    if (product.matrix.cwiseAbs().maxCoeff() > 1e140) {
      product.matrix *= 1e-140;
      product.exponent += 140;
    }
    return product;
  }
};

Scaled power(const Scaled& base, int n) {
  if (n == 1) return base;
  const Scaled half = power(base, n / 2);
  const Scaled square = half.times(half);
  return n % 2 == 0 ? square : base.times(square);
}

}  // namespace

double kolmogorov_cdf(int n, double d) {
  const double s = d * d * n;
  if (d <= 0) return 0;
  if (d >= 1) return 1;
  // The authors' shortcut, with seven digits in the tail.
  if (s > 7.24 || (s > 3.76 && n > 99))
    return 1 - 2 * std::exp(-(2.000071 + 0.331 / std::sqrt(n) + 1.409 / n) * s);
  const int k = static_cast<int>(n * d) + 1, m = 2 * k - 1;
  const double h = k - n * d;
  Eigen::MatrixXd matrix(m, m);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) matrix(i, j) = i - j + 1 < 0 ? 0 : 1;
  }
  for (int i = 0; i < m; ++i) {
    matrix(i, 0) -= std::pow(h, i + 1);
    matrix(m - 1, i) -= std::pow(h, m - i);
  }
  matrix(m - 1, 0) += 2 * h - 1 > 0 ? std::pow(2 * h - 1, m) : 0;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) {
      for (int g = 2; g <= i - j + 1; ++g) matrix(i, j) /= g;
    }
  }
  const Scaled raised = power({matrix, 0}, n);
  double value = raised.matrix(k - 1, k - 1);
  int exponent = raised.exponent;
  for (int i = 1; i <= n; ++i) {
    value = value * i / n;
    if (value < 1e-140) {
      value *= 1e140;
      exponent -= 140;
    }
  }
  return value * std::pow(10.0, exponent);
}

KolmogorovTest kolmogorov_test(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double d = distance(values, 0, 1);
  return {d, std::clamp(1 - kolmogorov_cdf(static_cast<int>(values.size()), d), 0.0, 1.0)};
}

KolmogorovTest lilliefors_test(std::vector<double> values, std::uint64_t seed) {
  const double d = standardized_distance(values);
  Rng rng(seed, 0);
  int larger = 0;
  for (int i = 0; i < lilliefors_samples; ++i) {
    for (double& value : values) value = rng.normal();
    larger += standardized_distance(values) > d;
  }
  return {d, static_cast<double>(larger) / lilliefors_samples};
}

AndersonDarlingTest anderson_darling_test(std::vector<double> values) {
  constexpr std::size_t fewest = 5;
  std::sort(values.begin(), values.end());
  if (values.size() < fewest || !(values.front() < values.back())) return {};
  spread_ties(values);
  Eigen::Map<Eigen::ArrayXd> x(values.data(), std::ssize(values));
  const double n = static_cast<double>(values.size()), mean = x.mean();
  const double sd = std::sqrt((x - mean).square().sum() / (n - 1));
  x = (x - mean) / sd;
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    constexpr double least = 1e-300;  // smallest argument of a logarithm
    const double below = std::max(normal_cdf(values[i]), least);
    const double above = std::max(normal_cdf(-values[values.size() - 1 - i]), least);
    sum += (2 * static_cast<double>(i) + 1) * (std::log(below) + std::log(above));
  }
  const double statistic = -n - sum / n;
  return {statistic, anderson_darling_p(statistic * (1 + 0.75 / n + 2.25 / (n * n)))};
}

ShapiroWilkTest shapiro_wilk_test(std::vector<double> values) {
  constexpr std::size_t fewest = 5;
  std::sort(values.begin(), values.end());
  if (values.size() < fewest || !(values.front() < values.back())) return {};
  spread_ties(values);
  const std::vector<double> a = shapiro_wilk_coefficients(values.size());
  double slope = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    slope += a[i] * (values[values.size() - 1 - i] - values[i]);
  const Eigen::Map<const Eigen::ArrayXd> x(values.data(), std::ssize(values));
  const double squares = (x - x.mean()).square().sum();
  // The rounding error of values on a straight line.
  constexpr double least = 1e-15;
  const double one_less_w = std::max((squares - slope * slope) / squares, least);
  const double score = shapiro_wilk_score(one_less_w, static_cast<double>(values.size()));
  return {1 - one_less_w, score, normal_cdf(-score)};
}

NormalPlot normal_plot(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  NormalPlot plot{{}, values};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(values.size());
    plot.quantile.push_back(-std::numbers::sqrt2 * boost::math::erfc_inv(2 * p));
  }
  return plot;
}

}  // namespace wearwell
