#include "wearwell/predict/count_quantile.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/negative_binomial.hpp>
#include <boost/math/distributions/poisson.hpp>
#include <cmath>

#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

constexpr std::array count_levels = {0.01, 0.05, 0.3, 0.5, 0.7, 0.95, 0.99};

// The smallest whole number with cdf of at least p.
template <class Cdf>
double first_with(const Cdf& cdf, double p) {
  double k = 0;
  while (cdf(k) < p) ++k;
  return k;
}

TEST(CountQuantile, PoissonAndBinomialAreExact) {
  for (const double mean : {0.01, 0.7, 3.0, 40.0, 2500.0}) {
    const CountAtPoint at{mean, mean, 1};
    const auto found = count_quantiles({&at, 1}, count_levels);
    const boost::math::poisson_distribution<> poisson(mean);
    for (std::size_t i = 0; i < count_levels.size(); ++i)
      EXPECT_EQ(found[i], first_with([&](double k) { return cdf(poisson, k); }, count_levels[i]))
          << mean;
  }
  for (const auto& [n, p] : {std::pair{1, 0.3}, {5, 0.9}, {80, 0.02}, {300, 0.5}, {2000, 0.999}}) {
    const CountAtPoint at{n * p, n * p * (1 - p), 2};  // weights need not sum to 1
    const auto found = count_quantiles({&at, 1}, count_levels);
    const boost::math::binomial_distribution<> binomial(n, p);
    for (std::size_t i = 0; i < count_levels.size(); ++i)
      EXPECT_EQ(found[i], first_with([&](double k) { return cdf(binomial, k); }, count_levels[i]))
          << n << " " << p << " " << count_levels[i];
  }
}

// A Poisson number with a gamma distributed mean has a negative binomial distribution.
TEST(CountQuantile, MixtureOverAPosterior) {
  constexpr double shape = 3, scale = 4;
  constexpr int n = 20000;
  std::vector<CountAtPoint> points;
  for (int i = 0; i < n; ++i) {
    const double mean = 120.0 * (i + 0.5) / n;
    points.push_back({mean, mean, std::pow(mean, shape - 1) * std::exp(-mean / scale)});
  }
  const auto found = count_quantiles(points, count_levels);
  const boost::math::negative_binomial_distribution<> exact(shape, 1 / (1 + scale));
  for (std::size_t i = 0; i < count_levels.size(); ++i)
    EXPECT_EQ(found[i], first_with([&](double k) { return cdf(exact, k); }, count_levels[i]));
}

// Units of unequal probability: the exact distribution by convolution.
TEST(CountQuantile, UnequalUnits) {
  Rng rng(1, 1);
  for (int repeat = 0; repeat < 30; ++repeat) {
    const double most = rng.uniform(0.02, 0.6);
    std::vector<double> density = {1};
    CountAtPoint at{0, 0, 1};
    for (int unit = 0; unit < 150; ++unit) {
      const double p = most * rng.uniform();
      at.mean += p;
      at.variance += p * (1 - p);
      density.push_back(0);
      for (std::size_t k = density.size() - 1; k > 0; --k)
        density[k] = density[k] * (1 - p) + density[k - 1] * p;
      density[0] *= 1 - p;
    }
    const auto found = count_quantiles({&at, 1}, count_levels);
    for (std::size_t i = 0; i < count_levels.size(); ++i) {
      double below = 0, until = 0;
      for (std::size_t k = 0; k < density.size() && k <= static_cast<std::size_t>(found[i]); ++k) {
        below = until;
        until += density[k];
      }
      constexpr double close = 1e-3;  // of the cumulative probability
      EXPECT_GE(until, count_levels[i] - close);
      EXPECT_LT(below, count_levels[i] + close);
    }
  }
}

// Long ranges are searched with incomplete gamma and beta functions.
TEST(CountQuantile, LongRanges) {
  const std::array points = {CountAtPoint{10, 10, 0.5}, CountAtPoint{4e6, 2e6, 0.5}};
  const std::array middle = {0.25, 0.75};
  const auto found = count_quantiles(points, middle);
  EXPECT_EQ(found[0], 10);  // the median of a Poisson distribution
  EXPECT_NEAR(found[1], 4e6, 1);
}

TEST(CountQuantile, Edges) {
  const CountAtPoint none{0, 0, 1}, sure{7, 0, 1}, nan{std::nan(""), 1, 1};
  EXPECT_EQ(count_quantiles({&none, 1}, count_levels),
            std::vector<double>(count_levels.size(), 0.0));
  EXPECT_EQ(count_quantiles({&sure, 1}, count_levels),
            std::vector<double>(count_levels.size(), 7.0));
  EXPECT_TRUE(std::isnan(count_quantiles({&nan, 1}, count_levels)[0]));
  EXPECT_TRUE(std::isnan(count_quantiles({}, count_levels)[0]));
}

}  // namespace
}  // namespace wearwell
