#include "wearwell/predict/normal_lines.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace wearwell {
namespace {

constexpr double first = -8.25, step = 0.25;
constexpr double shares[] = {1e-4, 0.01, 0.1, 0.37, 0.5, 0.9, 0.99, 0.9999};

template <class Value>
std::vector<double> along(const Value& value) {
  std::vector<double> all;
  for (double z = first; z <= -first; z += step) all.push_back(value(z));
  return all;
}

double normal_at(double p) {
  return boost::math::quantile(boost::math::normal(), p);
}

double normal_below(double z) {
  return boost::math::cdf(boost::math::normal(), z);
}

TEST(NormalLines, QuantilesOfALognormalNumberAreItsOwn) {
  for (const double sd : {-0.7, -0.05, 0.05, 0.7, 2.0}) {
    NormalLines lines;
    lines.add(0.3, first, step, along([&](double z) { return std::exp(1 + sd * z); }));
    for (const double p : shares) {
      const double expected = std::exp(1 + std::abs(sd) * normal_at(p));
      EXPECT_NEAR(lines.quantile(p) / expected, 1, 1e-7) << sd << ' ' << p;
      EXPECT_NEAR(lines.cdf(expected), p, 1e-9) << sd << ' ' << p;
    }
  }
}

// 10/(1 + 0.2 z): the life of a path whose rate is normal; for z < -5 it never ends.
TEST(NormalLines, LivesThatMayNeverEnd) {
  NormalLines lines;
  lines.add(1, first, step,
            along([](double z) { return 1 + 0.2 * z > 0 ? 10 / (1 + 0.2 * z) : INFINITY; }));
  for (const double p : shares)
    EXPECT_NEAR(lines.quantile(p) * (1 - 0.2 * normal_at(p)) / 10, 1, 2e-5) << p;
  NormalLines often;
  often.add(1, first, step,
            along([](double z) { return 1 + 2 * z > 0 ? 10 / (1 + 2 * z) : INFINITY; }));
  const double ends = normal_below(0.5);
  EXPECT_EQ(often.quantile(ends + 0.01), INFINITY);
  EXPECT_NEAR(often.cdf(1e6), ends, 1e-5);
  EXPECT_NEAR(often.quantile(0.5 * ends) * (1 - 2 * normal_at(0.5 * ends)) / 10, 1, 1e-3);
}

TEST(NormalLines, AMixtureIsTheSumOfItsLines) {
  NormalLines lines;
  lines.add(0.2, first, step, along([](double z) { return std::exp(0.4 * z); }));
  lines.add(0.6, first, step, along([](double z) { return 3 * std::exp(-0.1 * z); }));
  for (const double x : {0.5, 1.0, 2.5, 3.0, 4.0}) {
    const double expected =
        0.25 * normal_below(std::log(x) / 0.4) + 0.75 * normal_below(std::log(x / 3) / 0.1);
    EXPECT_NEAR(lines.cdf(x), expected, 1e-9) << x;
    EXPECT_NEAR(lines.quantile(expected) / x, 1, 1e-7) << x;
  }
}

// z^2 falls and rises.
TEST(NormalLines, ALineThatTurns) {
  NormalLines lines;
  lines.add(1, first, step, along([](double z) { return z * z; }));
  const boost::math::chi_squared distribution(1);
  for (const double p : {0.3, 0.5, 0.9, 0.99})
    EXPECT_NEAR(lines.quantile(p) / boost::math::quantile(distribution, p), 1, 5e-5) << p;
}

TEST(NormalLines, WhatIsNotANumberHasNoDistribution) {
  NormalLines lines;
  lines.add(1, first, step, along([](double z) { return z < 0 ? NAN : z; }));
  EXPECT_TRUE(std::isnan(lines.quantile(0.5)));
  EXPECT_TRUE(std::isnan(NormalLines().cdf(1)));
}

}  // namespace
}  // namespace wearwell
