// Ages of units with their own rates of use: integrals by R (tests/golden/use_rate.R), closed forms, derivatives.
#include "wearwell/prob/use_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "wearwell/prob/life_mixture.h"

namespace wearwell {
namespace {

using enum ResponseFamily;

struct Named {
  ResponseFamily family;
  double parameters[most_response_parameters];
};

// As in tests/golden/use_rate.R.
const std::map<std::string, Named> lives = {{"weibull", {weibull, {60, 1.6}}},
                                            {"lognormal", {lognormal, {50, 0.5}}},
                                            {"gamma", {gamma, {2.5, 20}}}};
const std::map<std::string, Named> rates = {{"lognormal", {lognormal, {1.2, 0.7}}},
                                            {"weibull", {weibull, {1.5, 1.8}}},
                                            {"gamma", {gamma, {3, 0.5}}}};

// The family gamma by the order of its parameters.
Named in_order(Named named) {
  if (named.family == gamma && form_of(gamma).family_parameters[0].kind == ParameterKind::scale)
    std::swap(named.parameters[0], named.parameters[1]);
  return named;
}

TEST(UseRate, IntegralsOfR) {
  std::ifstream golden(PROJECT_SOURCE_DIR "/tests/golden/use_rate.csv");
  std::string line;
  ASSERT_TRUE(std::getline(golden, line));
  int rows = 0;
  for (; std::getline(golden, line); ++rows) {
    std::istringstream cells(line);
    std::string life, rate, cell;
    std::getline(cells, life, ',');
    std::getline(cells, rate, ',');
    std::vector<double> number;
    while (std::getline(cells, cell, ',')) number.push_back(std::stod(cell));
    ASSERT_EQ(number.size(), 4U);
    const Named u = in_order(lives.at(life)), r = in_order(rates.at(rate));
    const LifeAtRate unit{u.family, r.family, u.parameters, r.parameters};
    const double age = number[0];
    const auto near = [&](double found, double expected) {
      EXPECT_NEAR(found, expected, 3e-8 * expected) << line;
    };
    near(std::exp(log_response(unit, {.seen = Censoring::right, .at = age})), number[1]);
    near(std::exp(log_response(unit, {.at = age})), number[2]);
    near(failing_within(unit, age, 40), number[3]);
    // R's numbers of the failed are differences from 1.
    EXPECT_NEAR(std::exp(log_response(unit, {.seen = Censoring::left, .at = age})), 1 - number[1],
                3e-9);
  }
  EXPECT_EQ(rows, 27);
}

double log_normal_survival(double z) {
  return std::log(0.5 * std::erfc(z / std::sqrt(2.0)));
}

// log T is the difference of two normal variables, also where one scatters little, and far in the tails.
TEST(UseRate, LognormalLifeAndRateAreALognormalAge) {
  for (const auto& [life_sd, rate_sd] :
       {std::pair(0.5, 0.7), {0.05, 1.5}, {2.0, 0.03}, {0.4, 0.4}}) {
    const double u[] = {50, life_sd, 0, 0}, r[] = {1.25, rate_sd, 0, 0};
    const LifeAtRate unit{lognormal, lognormal, u, r};
    const double sd = std::hypot(life_sd, rate_sd);
    for (const double z : {-7.0, -2.0, 0.0, 1.3, 6.0, 9.0}) {
      const double age = 40 * std::exp(z * sd);
      EXPECT_NEAR(log_response(unit, {.seen = Censoring::right, .at = age}), log_normal_survival(z),
                  1e-9);
      EXPECT_NEAR(log_response(unit, {.seen = Censoring::left, .at = age}), log_normal_survival(-z),
                  1e-9);
      EXPECT_NEAR(log_response(unit, {.at = age}),
                  -0.5 * z * z - 0.5 * std::log(2 * 3.14159265358979323846) - std::log(sd * age),
                  1e-9);
      const double share = 0.5 * std::erfc(-z / std::sqrt(2.0));
      EXPECT_NEAR(std::exp(log_response(
                      unit, {.seen = Censoring::interval, .at = 40, .until = 40 * std::exp(sd)})),
                  0.5 * std::erf(1 / std::sqrt(2.0)), 1e-10);
      EXPECT_NEAR(failing_within(unit, age, INFINITY), share, 1e-9 * share);
    }
  }
}

// A mean of exp(-r t/eta) over a gamma distribution is its Laplace transform: Lomax ages.
TEST(UseRate, ExponentialLifeAndGammaRateAreALomaxAge) {
  const Named rate = in_order({gamma, {3, 0.5}});
  const double u[] = {60, 0, 0, 0};
  const LifeAtRate unit{exponential, gamma, u, rate.parameters};
  for (const double age : {0.1, 5.0, 80.0, 1000.0, 1e5}) {
    const double growth = std::log1p(age * 0.5 / 60);
    EXPECT_NEAR(log_response(unit, {.seen = Censoring::right, .at = age}), -3 * growth, 1e-9);
    EXPECT_NEAR(log_response(unit, {.at = age}), std::log(3 * 0.5 / 60) - 4 * growth, 1e-9);
  }
}

TEST(UseRate, DerivativesAreThoseOfDifferences) {
  for (const auto& [life_name, life] : lives) {
    for (const auto& [rate_name, rate] : rates) {
      for (const Response& y :
           {Response{Censoring::none, 30}, Response{Censoring::right, 70},
            Response{Censoring::left, 12}, Response{Censoring::interval, 20, 45}}) {
        const Named u = in_order(life), r = in_order(rate);
        double slope[2 * most_response_parameters];
        log_response({u.family, r.family, u.parameters, r.parameters}, y, slope);
        for (std::size_t s = 0; s < 2; ++s) {
          for (const bool of_rate : {false, true}) {
            const auto moved = [&](double factor) {
              Named own_u = u, own_r = r;
              (of_rate ? own_r : own_u).parameters[s] *= factor;
              return log_response({u.family, r.family, own_u.parameters, own_r.parameters}, y);
            };
            const double x = (of_rate ? r : u).parameters[s],
                         expected = (moved(1 + 1e-5) - moved(1 - 1e-5)) / (2e-5 * x);
            EXPECT_NEAR(slope[s + (of_rate ? most_response_parameters : 0)], expected,
                        1e-5 * (1 / x + std::abs(expected)))
                << life_name << " " << rate_name << " " << s << of_rate;
          }
        }
      }
    }
  }
}

// Shares of the rates of survivors: the distribution function against the integral of S(rt) g(r), by halves.
TEST(UseRate, RatesOfSurvivorsAreBelowThoseOfAll) {
  const double u[] = {50, 0.5, 0, 0}, r[] = {1.25, 0.7, 0, 0};
  const LifeAtRate unit{lognormal, lognormal, u, r};
  // Given T = t, log R is normal (two normal variables with a known difference).
  const double age = 60, variance = 0.25 + 0.49,
               mean = std::log(1.25) - 0.49 / variance * (std::log(age) - std::log(40.0)),
               sd = std::sqrt(0.25 * 0.49 / variance);
  EXPECT_NEAR(std::log(rate_given(unit, {.at = age}, 0.5)), mean, 0.02 * sd);
  EXPECT_NEAR(std::log(rate_given(unit, {.at = age}, 0.841344746)), mean + sd, 0.03 * sd);
  EXPECT_LT(rate_given(unit, {.seen = Censoring::right, .at = 200}, 0.5), 0.6);
}

TEST(UseRate, AMixtureHasAgesLikeOneFamily) {
  const LifeMixture plain{.families = {weibull}, .rate = lognormal},
      two{.families = {weibull, lognormal}, .rest = 1, .limited = true, .rate = lognormal};
  const double r[] = {1.2, 0.7, 0, 0}, first[] = {60, 1.6, 0, 0}, second[] = {20, 0.5, 0, 0};
  std::vector<double> x(plain.parameters()), y(two.parameters());
  std::copy_n(first, 4, x.begin());
  std::copy_n(r, 4, x.begin() + static_cast<std::ptrdiff_t>(plain.of_rate()));
  std::copy_n(first, 4, y.begin());
  std::copy_n(second, 4, y.begin() + 4);
  y[two.share(0)] = 0.3;
  y[two.share_defective()] = 0.8;
  std::copy_n(r, 4, y.begin() + static_cast<std::ptrdiff_t>(two.of_rate()));
  const LifeAtRate one{weibull, lognormal, first, r}, other{lognormal, lognormal, second, r};
  for (const double age : {3.0, 36.0, 120.0}) {
    const Response by{Censoring::left, age};
    EXPECT_NEAR(plain.log_cdf(age, x.data()), log_response(one, by), 1e-13);
    EXPECT_NEAR(
        std::exp(two.log_cdf(age, y.data())),
        0.8 * (0.3 * std::exp(log_response(one, by)) + 0.7 * std::exp(log_response(other, by))),
        1e-13);
    EXPECT_NEAR(plain.quantile(std::exp(plain.log_cdf(age, x.data())), x.data()), age, 1e-9 * age);
    EXPECT_NEAR(two.quantile(std::exp(two.log_cdf(age, y.data())), y.data()), age, 1e-9 * age);
    std::vector<double> slope(y.size());
    two.log_response({Censoring::right, age}, y.data(), slope);
    for (std::size_t s = 0; s < y.size(); ++s) {
      if (y[s] == 0) continue;
      std::vector<double> up = y, down = y;
      up[s] *= 1 + 1e-6, down[s] *= 1 - 1e-6;
      EXPECT_NEAR(
          slope[s],
          (two.log_survival(age, up.data()) - two.log_survival(age, down.data())) / (2e-6 * y[s]),
          1e-5 * (1 + std::abs(slope[s])))
          << s;
    }
  }
}

TEST(UseRate, InvalidParametersHaveNoProbability) {
  const double good[] = {50, 0.5, 0, 0}, bad[] = {50, -0.5, 0, 0};
  EXPECT_EQ(log_response({lognormal, lognormal, bad, good}, {.at = 3}), -INFINITY);
  EXPECT_EQ(log_response({lognormal, lognormal, good, bad}, {.at = 3}), -INFINITY);
  EXPECT_TRUE(std::isnan(failing_within({lognormal, lognormal, good, bad}, 3, 5)));
}

// Ages that share their integrals, exact and censored, between the nodes and far in the tails.
TEST(UseRate, SharedIntegralsAreThoseOfEachAge) {
  for (const auto& [life, of_life] : lives) {
    for (const auto& [rate, of_rate] : rates) {
      const Named u = in_order(of_life), r = in_order(of_rate);
      const LifeAtRate unit{u.family, r.family, u.parameters, r.parameters};
      for (const Censoring seen : {Censoring::none, Censoring::right}) {
        for (double age = 0.03; age < 3000; age *= 1.37) {
          double own[2 * most_response_parameters], shared[2 * most_response_parameters];
          const Response at{.seen = seen, .at = age};
          const double alone = log_response(unit, at, own);
          const SharedAges ages;
          const double together = log_response(unit, at, shared);
          EXPECT_NEAR(together, alone, 2e-6 * (1 + std::abs(alone)))
              << life << ' ' << rate << ' ' << age;
          for (std::size_t s = 0; s < 2 * most_response_parameters; ++s)
            EXPECT_NEAR(shared[s], own[s], 2e-5 * (1 + std::abs(own[s])))
                << life << ' ' << rate << ' ' << age << ' ' << s;
        }
      }
    }
  }
}

}  // namespace
}  // namespace wearwell
