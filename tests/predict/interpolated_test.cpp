#include "wearwell/predict/interpolated.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace wearwell {
namespace {

// Two correlated normal parameters as the cells of a quadrature.
WeightedDraws normal_cells() {
  constexpr int n = 281;
  constexpr double step = 0.04, rho = 0.6;
  WeightedDraws draws;
  draws.values.resize(n * n, 2);
  draws.weights.resize(n * n);
  draws.lower.assign(2, Points(n * n, 2));
  draws.upper = draws.lower;
  const auto parameters = [&](double a, double b) {
    return Eigen::RowVector2d(3 + 0.2 * a, 50 + 5 * (rho * a + std::sqrt(1 - rho * rho) * b));
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double a = step * (i - n / 2), b = step * (j - n / 2), half = 0.5 * step;
      const int at = i * n + j;
      draws.values.row(at) = parameters(a, b);
      draws.lower[0].row(at) = parameters(a - half, b);
      draws.upper[0].row(at) = parameters(a + half, b);
      draws.lower[1].row(at) = parameters(a, b - half);
      draws.upper[1].row(at) = parameters(a, b + half);
      draws.weights[at] = std::exp(-0.5 * (a * a + b * b));
    }
  }
  draws.weights /= draws.weights.sum();
  return draws;
}

Points values_at(const ThinnedPosterior& few, double (*value)(const double* x)) {
  Points values(few.values.rows(), 1);
  for (Eigen::Index i = 0; i < values.rows(); ++i) values(i, 0) = value(few.values.row(i).data());
  return values;
}

// exp(0.5 x + 0.02 y) is lognormal: its quantiles are closed forms.
TEST(Interpolated, QuantilesAreThoseOfTheWholePosterior) {
  const WeightedDraws draws = normal_cells();
  const ThinnedPosterior few(draws, 2000);
  const auto found = interpolated(draws, few, values_at(few, [](const double* x) {
                                    return std::exp(0.5 * x[0] + 0.02 * x[1]);
                                  }));
  ASSERT_TRUE(found.front());
  const double mean = 0.5 * 3 + 0.02 * 50;
  const double sd = std::sqrt(0.01 + 0.01 + 2 * 0.6 * 0.1 * 0.1);
  for (const double p : {0.01, 0.05, 0.1, 0.5, 0.9, 0.95}) {
    const double expected = std::exp(mean + sd * boost::math::quantile(boost::math::normal(), p));
    EXPECT_NEAR(found.front()->distribution.quantile(p) / expected, 1, 1e-4) << p;
  }
}

// Against the same number at every cell, where no closed form is.
TEST(Interpolated, CurvedNumbersToo) {
  const WeightedDraws draws = normal_cells();
  const ThinnedPosterior few(draws, 2000);
  const auto value = [](const double* x) { return x[1] / (1 + 0.2 * x[0] * x[0]); };
  const auto found = interpolated(draws, few, values_at(few, value));
  ASSERT_TRUE(found.front());
  const QuantityDistribution direct(draws, value);
  for (const double p : {0.01, 0.05, 0.5, 0.95, 0.99})
    EXPECT_NEAR(found.front()->distribution.quantile(p) / direct.quantile(p), 1, 1e-5) << p;
}

TEST(Interpolated, WhatIsNotSmoothHasNone) {
  const WeightedDraws draws = normal_cells();
  const ThinnedPosterior few(draws, 2000);
  EXPECT_FALSE(
      interpolated(draws, few, values_at(few, [](const double* x) { return std::abs(x[0] - 3); }))
          .front());
  EXPECT_FALSE(
      interpolated(draws, few,
                   values_at(few, [](const double* x) { return x[0] > 3 ? INFINITY : 1.0; }))
          .front());
}

}  // namespace
}  // namespace wearwell
