#include "wearwell/prob/distribution.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "support/between.h"
#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"
#include "wearwell/prob/response.h"

namespace wearwell {
namespace {

Family family_of(const std::string& name, double a, double b, double c) {
  if (name == "normal") return Normal{a, b};
  if (name == "lognormal") return Lognormal{std::exp(a), b};
  if (name == "gamma") return Gamma{a, b};
  if (name == "inverse-gamma") return InverseGamma{a, b};
  if (name == "student-t") return StudentT{a, b, c};
  if (name == "beta") return Beta{a, b};
  throw std::logic_error("no family " + name);
}

TEST(Distribution, MatchesR) {
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
    const Distribution distribution =
        make_distribution(family_of(name, v[0], v[1], v[2]), v[3], v[4]);
    EXPECT_TRUE(distribution.proper);
    EXPECT_NEAR(log_density(distribution, v[5]).value, v[6], 1e-11 * std::max(1.0, std::abs(v[6])));
    EXPECT_NEAR(quantile(distribution, v[7]), v[8], 1e-10 * std::abs(v[8]));
  }
  EXPECT_EQ(rows, 72);
}

TEST(Distribution, FlatUniformAndJeffreys) {
  const Distribution uniform = make_distribution(Uniform{}, 2e-9, 10e-9);
  EXPECT_NEAR(log_density(uniform, 5e-9).value, -std::log(8e-9), 1e-14);
  EXPECT_DOUBLE_EQ(quantile(uniform, 0.25), 4e-9);

  const Distribution cut = make_distribution(Flat{}, -1, 3);
  EXPECT_TRUE(cut.proper);
  EXPECT_DOUBLE_EQ(log_density(cut, 0).value, -std::log(4));
  const Distribution flat = make_distribution(Flat{}, 0, infinity);
  EXPECT_FALSE(flat.proper);
  EXPECT_EQ(log_density(flat, 1e-300).value, log_density(flat, 1e300).value);
  EXPECT_THROW(quantile(flat, 0.5), std::logic_error);

  // 1/x on [1, e^2] integrates to 2, and its median is e.
  const Distribution jeffreys = make_distribution(Jeffreys{}, 1, std::exp(2));
  EXPECT_NEAR(log_density(jeffreys, 3).value, -std::log(3) - std::log(2), 1e-15);
  EXPECT_NEAR(quantile(jeffreys, 0.5), std::exp(1), 1e-15);
  EXPECT_FALSE(make_distribution(Jeffreys{}, 0, 1).proper);
  EXPECT_FALSE(make_distribution(Jeffreys{}, 1, infinity).proper);
}

// By name, with as many parameters as it has.
Family of(const std::string& name, const std::vector<double>& parameters) {
  for (const ResponseForm& form : prior_forms()) {
    if (form.name != name || form.family_parameters.size() != parameters.size()) continue;
    Family family{form.family};
    std::copy(parameters.begin(), parameters.end(), family.parameter.begin());
    return family;
  }
  throw std::logic_error("no family " + name);
}

Distribution any_distribution() {
  static const std::vector<Family> families = {Normal{1, 2},
                                               Lognormal{0.2, 0.6},
                                               Gamma{1, 3},
                                               Gamma{2.5, 0.8},
                                               InverseGamma{3, 0.04},
                                               StudentT{3, 0.5, 2.},
                                               StudentT{1, 0, 1},
                                               Beta{2, 1.5},
                                               Beta{1, 1},
                                               HalfNormal{2},
                                               of("half-cauchy", {0.7}),
                                               of("exponential", {1.5}),
                                               of("weibull", {1.2, 2.5}),
                                               of("weibull", {1.2, 2.5, -0.5}),
                                               of("loglogistic", {0.8, 3}),
                                               of("inverse-gaussian", {1, 2}),
                                               of("smallest-extreme-value", {1, 0.5}),
                                               of("largest-extreme-value", {1, 0.5}),
                                               of("log10-normal", {1, 0.3}),
                                               of("generalized-gamma", {1, 0.6, -0.5}),
                                               of("generalized-gamma", {1, 0.6, 0.02}),
                                               of("birnbaum-saunders", {1, 0.8}),
                                               of("frechet", {0.01, 2.5}),
                                               of("exponentiated-weibull", {1, 1.5, 2}),
                                               Flat{},
                                               Uniform{},
                                               Jeffreys{}};
  const Family family = families[*rc::gen::inRange<std::size_t>(0, families.size())];
  const double lower = *between(1e-3, 0.9);
  return make_distribution(family, lower, lower + *between(1e-3, 50));
}

RC_GTEST_PROP(Distribution, DensityIntegratesToOne, ()) {
  const Distribution distribution = any_distribution();
  const double mass = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      [&](double x) { return std::exp(log_density(distribution, x).value); }, distribution.lower,
      distribution.upper, 15, 1e-10);
  RC_ASSERT(std::abs(mass - 1) < 1e-8);
}

RC_GTEST_PROP(Distribution, QuantileInvertsTheIntegral, ()) {
  const Distribution distribution = any_distribution();
  const double p = *between(1e-3, 0.999);
  const double x = quantile(distribution, p);
  RC_ASSERT(distribution.lower <= x && x <= distribution.upper);
  const double below = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      [&](double t) { return std::exp(log_density(distribution, t).value); }, distribution.lower, x,
      15, 1e-10);
  RC_ASSERT(std::abs(below - p) < 1e-8);
}

RC_GTEST_PROP(Distribution, SlopeIsTheDifferenceQuotient, ()) {
  const Distribution distribution = any_distribution();
  const double x =
      distribution.lower + (distribution.upper - distribution.lower) * *between(0.05, 0.95);
  const double h = 1e-5 * (distribution.upper - distribution.lower) * 0.05;
  const double slope = log_density(distribution, x).slope;
  const double quotient =
      (log_density(distribution, x + h).value - log_density(distribution, x - h).value) / (2 * h);
  RC_ASSERT(std::abs(slope - quotient) < 1e-6 * std::abs(slope) + 1e-9 / h);
}

TEST(Distribution, SlopeAtSiScales) {
  // d/dx of -(x - m)^2 / (2 s^2) and of (a - 1) log x - x/b.
  EXPECT_DOUBLE_EQ(log_density(make_distribution(Normal{5e-13, 1e-13}, 0, infinity), 7e-13).slope,
                   -2e13);
  EXPECT_DOUBLE_EQ(log_density(make_distribution(Gamma{3, 1e-13}, 0, infinity), 4e-13).slope,
                   -0.5e13);
}

TEST(Distribution, StaysInsideTheNaturalSupport) {
  const Distribution distribution = make_distribution(Gamma{2, 1}, -5, infinity);
  EXPECT_EQ(distribution.lower, 0);
  EXPECT_EQ(distribution.upper, infinity);
  EXPECT_EQ(make_distribution(Beta{2, 2}, 0.5, 7).upper, 1);
}

// A slice much thinner than the law is nearly uniform, wherever it lies.
TEST(Distribution, ThinSlices) {
  for (const double at : {-1.0, 0.0, 0.5, 3.0}) {
    const double width = 1e-5;
    const Distribution distribution = make_distribution(Normal{0, 1}, at, at + width);
    EXPECT_NEAR(log_density(distribution, at + width / 2).value,
                -std::log(distribution.upper - distribution.lower), 1e-9)
        << at;
  }
}

TEST(Distribution, RefusesParametersOutOfRange) {
  const double nan = std::nan("");
  const std::vector<Family> wrong = {
      Normal{0, 0},        Normal{0, -1},          Normal{0, nan},     Normal{nan, 1},
      Normal{infinity, 1}, Lognormal{0, 0},        Lognormal{nan, 1},  Gamma{0, 1},
      Gamma{1, -1},        InverseGamma{-1, 1},    InverseGamma{1, 0}, StudentT{0, 0, 1},
      StudentT{3, 0, -1},  StudentT{3, nan, 1},    Beta{0, 1},         Beta{1, -2},
      Gamma{1, infinity},  Lognormal{-infinity, 1}};
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_THROW(make_distribution(wrong[i], 0, infinity), InputError) << i;
  }
}

TEST(Distribution, RefusesBounds) {
  EXPECT_THROW(make_distribution(Normal{0, 1}, 1, 1), InputError);
  EXPECT_THROW(make_distribution(Normal{0, 1}, 2, 1), InputError);
  EXPECT_THROW(make_distribution(Normal{0, 1}, std::nan(""), 1), InputError);
  EXPECT_THROW(make_distribution(Gamma{1, 1}, -2, -1), InputError);
  EXPECT_THROW(make_distribution(Beta{1, 1}, 1, 2), InputError);
  EXPECT_THROW(make_distribution(Uniform{}, 0, infinity), InputError);
  EXPECT_THROW(make_distribution(Normal{0, 1}, 100, 101), InputError);  // e^-5000
}

// Each family of a likelihood, as a prior: the same density over the probability between its bounds, whose
// quantiles are the probability's inverse, far in either tail as well.
TEST(Distribution, EveryFamilyIsAPrior) {
  int tried = 0;
  for (const ResponseForm& form : prior_forms()) {
    if (form.prior_only) continue;
    Family family{form.family};
    for (std::size_t i = 0; i < form.family_parameters.size(); ++i)
      family.parameter[i] =
          form.family_parameters[i].name == "threshold" ? 0.1 : 1.3 - 0.4 * double(i);
    const double* s = family.parameter.data();
    const double at[] = {quantile(form.family, 1e-9, s), quantile(form.family, 0.3, s),
                         quantile(form.family, 0.6, s), quantile(form.family, 1 - 1e-6, s)};
    for (const auto& [lower, upper] :
         {std::pair{-infinity, infinity}, {-infinity, at[1]}, {at[1], at[2]}, {at[3], infinity}}) {
      SCOPED_TRACE(testing::Message() << form.name << " " << form.family_parameters.size() << ": "
                                      << lower << " to " << upper);
      const Distribution distribution = make_distribution(family, lower, upper);
      const auto mass = [&](double x) {
        const Response y{Censoring::interval, std::max(lower, -1e300), x};
        return log_response_value(form.family,
                                  lower > distribution.lower - 1 && std::isfinite(lower)
                                      ? y
                                      : Response{Censoring::left, x},
                                  s);
      };
      const double all = upper == infinity && lower == -infinity ? 0
                         : upper == infinity ? log_survival(form.family, lower, s)
                                             : mass(upper);
      for (const double p : {0.02, 0.5, 0.97}) {
        const double x = quantile(distribution, p);
        EXPECT_NEAR(std::exp(mass(x) - all), p, 1e-7) << x;
        EXPECT_NEAR(log_density(distribution, x).value,
                    log_response_value(form.family, {Censoring::none, x}, s) - all, 1e-8);
        const double step = 1e-6 * std::min(std::abs(x), x - distribution.lower);
        EXPECT_NEAR(log_density(distribution, x).slope,
                    (log_density(distribution, x + step).value -
                     log_density(distribution, x - step).value) /
                        (2 * step),
                    1e-5 * (1 + std::abs(log_density(distribution, x).slope)));
      }
    }
    ++tried;
  }
  EXPECT_GE(tried, 25);
}

}  // namespace
}  // namespace wearwell
