#include "wearwell/prob/law.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/between.h"
#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

Family family_of(const std::string& name, double a, double b, double c) {
  if (name == "normal") return Normal{a, b};
  if (name == "lognormal") return Lognormal{a, b};
  if (name == "gamma") return Gamma{a, b};
  if (name == "inverse-gamma") return InverseGamma{a, b};
  if (name == "student-t") return StudentT{a, b, c};
  if (name == "beta") return Beta{a, b};
  throw std::logic_error("no family " + name);
}

TEST(Law, MatchesR) {
  std::ifstream golden(PROJECT_SOURCE_DIR "/tests/golden/laws.csv");
  std::string line, name, cell;
  ASSERT_TRUE(std::getline(golden, line));
  int rows = 0;
  for (; std::getline(golden, line); ++rows) {
    SCOPED_TRACE(line);
    std::istringstream cells(line);
    std::getline(cells, name, ',');
    double v[9];
    for (double& value : v) {
      ASSERT_TRUE(std::getline(cells, cell, ','));
      value = std::stod(cell);
    }
    const Law law = make_law(family_of(name, v[0], v[1], v[2]), v[3], v[4]);
    EXPECT_TRUE(law.proper);
    EXPECT_NEAR(log_density(law, v[5]).value, v[6], 1e-11 * std::max(1.0, std::abs(v[6])));
    EXPECT_NEAR(quantile(law, v[7]), v[8], 1e-10 * std::abs(v[8]));
  }
  EXPECT_EQ(rows, 72);
}

TEST(Law, FlatUniformAndJeffreys) {
  const Law uniform = make_law(Uniform{}, 2e-9, 10e-9);
  EXPECT_NEAR(log_density(uniform, 5e-9).value, -std::log(8e-9), 1e-14);
  EXPECT_DOUBLE_EQ(quantile(uniform, 0.25), 4e-9);

  const Law cut = make_law(Flat{}, -1, 3);
  EXPECT_TRUE(cut.proper);
  EXPECT_DOUBLE_EQ(log_density(cut, 0).value, -std::log(4));
  const Law flat = make_law(Flat{}, 0, infinity);
  EXPECT_FALSE(flat.proper);
  EXPECT_EQ(log_density(flat, 1e-300).value, log_density(flat, 1e300).value);
  EXPECT_THROW(quantile(flat, 0.5), std::logic_error);

  // 1/x on [1, e^2] integrates to 2, and its median is e.
  const Law jeffreys = make_law(Jeffreys{}, 1, std::exp(2));
  EXPECT_NEAR(log_density(jeffreys, 3).value, -std::log(3) - std::log(2), 1e-15);
  EXPECT_NEAR(quantile(jeffreys, 0.5), std::exp(1), 1e-15);
  EXPECT_FALSE(make_law(Jeffreys{}, 0, 1).proper);
  EXPECT_FALSE(make_law(Jeffreys{}, 1, infinity).proper);
}

Law any_law() {
  static const std::vector<Family> families = {Normal{1, 2},
                                               Lognormal{0.2, 0.6},
                                               Gamma{1, 3},
                                               Gamma{2.5, 0.8},
                                               InverseGamma{3, 0.04},
                                               StudentT{3, 0.5, 2.},
                                               StudentT{1, 0, 1},
                                               Beta{2, 1.5},
                                               Beta{1, 1},
                                               Flat{},
                                               Uniform{},
                                               Jeffreys{}};
  const Family family = families[*rc::gen::inRange<std::size_t>(0, families.size())];
  const double lower = *between(1e-3, 0.9);
  return make_law(family, lower, lower + *between(1e-3, 50));
}

RC_GTEST_PROP(Law, DensityIntegratesToOne, ()) {
  const Law law = any_law();
  const double mass = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      [&](double x) { return std::exp(log_density(law, x).value); }, law.lower, law.upper, 15,
      1e-10);
  RC_ASSERT(std::abs(mass - 1) < 1e-8);
}

RC_GTEST_PROP(Law, QuantileInvertsTheIntegral, ()) {
  const Law law = any_law();
  const double p = *between(1e-3, 0.999);
  const double x = quantile(law, p);
  RC_ASSERT(law.lower <= x && x <= law.upper);
  const double below = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      [&](double t) { return std::exp(log_density(law, t).value); }, law.lower, x, 15, 1e-10);
  RC_ASSERT(std::abs(below - p) < 1e-8);
}

RC_GTEST_PROP(Law, SlopeIsTheDifferenceQuotient, ()) {
  const Law law = any_law();
  const double x = law.lower + (law.upper - law.lower) * *between(0.05, 0.95);
  const double h = 1e-5 * (law.upper - law.lower) * 0.05;
  const double slope = log_density(law, x).slope;
  const double quotient = (log_density(law, x + h).value - log_density(law, x - h).value) / (2 * h);
  RC_ASSERT(std::abs(slope - quotient) < 1e-6 * std::abs(slope) + 1e-9 / h);
}

TEST(Law, SlopeAtSiScales) {
  // d/dx of -(x - m)^2 / (2 s^2) and of (a - 1) log x - x/b.
  EXPECT_DOUBLE_EQ(log_density(make_law(Normal{5e-13, 1e-13}, 0, infinity), 7e-13).slope, -2e13);
  EXPECT_DOUBLE_EQ(log_density(make_law(Gamma{3, 1e-13}, 0, infinity), 4e-13).slope, -0.5e13);
}

TEST(Law, StaysInsideTheNaturalSupport) {
  const Law law = make_law(Gamma{2, 1}, -5, infinity);
  EXPECT_EQ(law.lower, 0);
  EXPECT_EQ(law.upper, infinity);
  EXPECT_EQ(make_law(Beta{2, 2}, 0.5, 7).upper, 1);
}

// A slice much thinner than the law is nearly uniform, wherever it lies.
TEST(Law, ThinSlices) {
  for (const double at : {-1.0, 0.0, 0.5, 3.0}) {
    const double width = 1e-5;
    const Law law = make_law(Normal{0, 1}, at, at + width);
    EXPECT_NEAR(log_density(law, at + width / 2).value, -std::log(law.upper - law.lower), 1e-9)
        << at;
  }
}

TEST(Law, RefusesParametersOutOfRange) {
  const double nan = std::nan("");
  const std::vector<Family> wrong = {
      Normal{0, 0},        Normal{0, -1},          Normal{0, nan},     Normal{nan, 1},
      Normal{infinity, 1}, Lognormal{0, 0},        Lognormal{nan, 1},  Gamma{0, 1},
      Gamma{1, -1},        InverseGamma{-1, 1},    InverseGamma{1, 0}, StudentT{0, 0, 1},
      StudentT{3, 0, -1},  StudentT{3, nan, 1},    Beta{0, 1},         Beta{1, -2},
      Gamma{1, infinity},  Lognormal{-infinity, 1}};
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_THROW(make_law(wrong[i], 0, infinity), InputError) << i;
  }
}

TEST(Law, RefusesBounds) {
  EXPECT_THROW(make_law(Normal{0, 1}, 1, 1), InputError);
  EXPECT_THROW(make_law(Normal{0, 1}, 2, 1), InputError);
  EXPECT_THROW(make_law(Normal{0, 1}, std::nan(""), 1), InputError);
  EXPECT_THROW(make_law(Gamma{1, 1}, -2, -1), InputError);
  EXPECT_THROW(make_law(Beta{1, 1}, 1, 2), InputError);
  EXPECT_THROW(make_law(Uniform{}, 0, infinity), InputError);
  EXPECT_THROW(make_law(Normal{0, 1}, 100, 101), InputError);  // e^-5000
}

}  // namespace
}  // namespace wearwell
