#include "wearwell/infer/residual_tests.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/exp_sinh.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <vector>

#include "wearwell/infer/fit_check.h"

namespace wearwell {
namespace {

double sum_of_squares(std::span<const double> z) {
  return std::inner_product(z.begin(), z.end(), z.begin(), 0.0);
}

double mean(std::span<const double> z) {
  return std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(z.size());
}

// Constant standardized residuals (all readings zero) have no trend except by rounding.
bool differ(std::span<const double> z) {
  constexpr double least = 1e-9;
  const auto [low, high] = std::minmax_element(z.begin(), z.end());
  return *high - *low > least;
}

std::vector<double> centered(std::span<const double> z) {
  const double m = mean(z);
  std::vector<double> rest;
  for (const double each : z) rest.push_back(each - m);
  return rest;
}

// P(T <= t) of Student's t with t^2 = freedom r^2/(1 - r^2), from the cosine r between residuals
// and a direction.
double below(double cosine, double freedom) {
  if (!(freedom >= 1) || std::isnan(cosine)) return 0.5;
  const double rest = 1 - cosine * cosine;
  if (rest <= 0) return cosine < 0 ? 0 : 1;
  const boost::math::students_t distribution(freedom);
  return cdf(distribution, cosine * std::sqrt(freedom / rest));
}

double two_sided(double cosine, double freedom) {
  return 2 * below(-std::abs(cosine), freedom);
}

double cosine(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0) /
         (std::sqrt(sum_of_squares(a)) * std::sqrt(sum_of_squares(b)));
}

// P(sum of a_j X_j^2 < 0) of independent standard normal X_j (Imhof 1961, Biometrika 48, 419-426).
double negative_form(const std::vector<double>& a) {
  if (a.front() >= 0) return 0;  // ascending
  if (a.back() <= 0) return 1;
  const auto integrand = [&](double u) {
    double angle = 0, log_size = 0;
    for (const double each : a) {
      angle += 0.5 * std::atan(each * u);
      log_size += 0.25 * std::log1p(each * each * u * u);
    }
    return std::sin(angle) * std::exp(-log_size) / u;
  };
  thread_local boost::math::quadrature::exp_sinh<double> rule;
  return std::clamp(0.5 - rule.integrate(integrand, 1e-9) / std::numbers::pi, 0.0, 1.0);
}

// Driver and value, centered within groups and scaled, and the number of groups.
struct Centered {
  std::vector<double> driver, value;
  std::size_t groups = 0;
};

Centered within_groups(const Rise& rise) {
  struct Sums {
    double n = 0, driver = 0, value = 0;
  };
  std::map<std::size_t, Sums> sums;
  const auto group = [&](std::size_t i) { return rise.group.empty() ? 0 : rise.group[i]; };
  for (std::size_t i = 0; i < rise.value.size(); ++i) {
    Sums& each = sums[group(i)];
    ++each.n;
    each.driver += rise.driver[i];
    each.value += rise.value[i];
  }
  Centered result{{}, {}, sums.size()};
  for (std::size_t i = 0; i < rise.value.size(); ++i) {
    const Sums& each = sums[group(i)];
    result.driver.push_back(rise.driver[i] - each.driver / each.n);
    result.value.push_back(rise.value[i] - each.value / each.n);
  }
  return result;
}

std::vector<double> scaled(std::vector<double> values) {
  double largest = 0;
  for (const double each : values) largest = std::max(largest, std::abs(each));
  if (largest > 0) {
    for (double& each : values) each /= largest;
  }
  return values;
}

}  // namespace

double scatter_test(std::span<const double> z) {
  const boost::math::chi_squared distribution(static_cast<double>(z.size()));
  const double q = sum_of_squares(z);
  return std::min(1.0, 2 * std::min(cdf(distribution, q), cdf(complement(distribution, q))));
}

double location_test(std::span<const double> z) {
  if (z.size() < 2) return 1;
  const std::vector<double> ones(z.size(), 1.0);
  return two_sided(cosine(z, ones), static_cast<double>(z.size()) - 1);
}

double trend_test(std::span<const double> z, std::span<const double> driver) {
  if (z.size() < 3 || !differ(z)) return 1;
  const std::vector<double> from_mean = scaled(centered(driver));
  return two_sided(cosine(centered(z), from_mean), static_cast<double>(z.size()) - 2);
}

double neighbour_test(std::span<const double> z) {
  if (z.size() < 4 || !differ(z)) return 1;
  const auto n = static_cast<double>(z.size());
  double differences = 0;
  for (std::size_t i = 0; i + 1 < z.size(); ++i) differences += std::pow(z[i + 1] - z[i], 2);
  const double ratio = differences / sum_of_squares(centered(z));
  if (std::isnan(ratio)) return 1;
  constexpr std::size_t most_exact = 40;
  if (z.size() <= most_exact) {
    std::vector<double> weights;
    for (double j = 1; j < n; ++j)
      weights.push_back(2 - 2 * std::cos(std::numbers::pi * j / n) - ratio);
    return negative_form(weights);
  }
  // Between 2 - c and 2 + c, with the variance of von Neumann (1941).
  const double c = 2 * std::cos(std::numbers::pi / n);
  const double variance = 4 * (n - 2) / ((n + 1) * (n - 1));
  const double shape = 0.5 * (c * c / variance - 1);
  const double x = std::clamp((ratio - 2 + c) / (2 * c), 0.0, 1.0);
  return cdf(boost::math::beta_distribution(shape, shape), x);
}

double extreme_test(std::span<const double> z) {
  if (z.size() < 3) return 1;
  const auto n = static_cast<double>(z.size());
  double largest = 0;
  for (const double each : z) largest = std::max(largest, each * each);
  const double share = largest / sum_of_squares(z);
  if (std::isnan(share)) return 1;
  const boost::math::beta_distribution distribution(0.5, 0.5 * (n - 1));
  return std::min(1.0, n * cdf(complement(distribution, std::min(share, 1.0))));
}

double fall_test(const Rise& rise) {
  const Centered data = within_groups(rise);
  const std::vector<double> driver = scaled(data.driver), value = scaled(data.value);
  const double freedom = static_cast<double>(value.size()) - static_cast<double>(data.groups) - 1;
  return freedom < 1 ? 1 : below(cosine(driver, value), freedom);
}

double sign_test(const Rise& rise) {
  if (rise.value.size() < 2) return 1;
  return below(cosine(scaled(rise.driver), scaled(rise.value)),
               static_cast<double>(rise.value.size()) - 1);
}

}  // namespace wearwell
