#include "wearwell/input/prior.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

class PriorTest : public ScratchTest {
 protected:
  // A length in SI, as a model of the user's may have; guess 3 mm.
  const ParameterSpec length{"x", "m", -infinity, infinity, 3e-3};
  const ParameterSpec positive{"x", "m", 0, infinity, 3e-3};
  const ParameterSpec plain{"x", "1", 0, infinity, 1};

  Parameter read(const std::string& prior, const ParameterSpec& spec) {
    const auto root = TomlReader::parse_file(write("a.toml", "x = { " + prior + " }\n"));
    Parameter parameter = read_prior(root, spec);
    root.finish();
    return parameter;
  }
  std::string refusal(const std::string& prior, const ParameterSpec& spec) {
    return message_of<InputError>([&] { read(prior, spec); });
  }
  // The density per mm at `mm`, as R gives it.
  double density(const std::string& prior, double mm) {
    return std::exp(log_density(read(prior, positive).prior, 1e-3 * mm).value) * 1e-3;
  }
};

// Each expression in R 4.2.2 stands beside its value.
TEST_F(PriorTest, EachLawIsTheOneItNames) {
  const auto expect = [&](const std::string& prior, double value) {
    EXPECT_NEAR(density(prior, 2) / value, 1, 1e-12) << prior;
  };
  expect(R"(distribution = "uniform", lower = "0 mm", upper = "8 mm")", 0.125);
  // dnorm(2, 3, .5)/pnorm(6)
  expect(R"(distribution = "normal", mean = "3 mm", sd = "0.5 mm")", 0.10798193313290977);
  // z <- sqrt(log1p(.25)); dlnorm(2, log(4) - z^2/2, z)
  expect(R"(distribution = "lognormal", mean = "4 mm", sd = "2 mm")", 0.19790048510440292);
  // dlnorm(2, log(3), .7)
  expect(R"(distribution = "lognormal", median = "3 mm", log_sd = 0.7)", 0.24094951093477759);
  // 2 * dnorm(2, 0, 1.5)
  expect(R"(distribution = "half-normal", scale = "1.5 mm")", 0.2186800995679915);
  // 2 * dcauchy(2, 0, 1.5)
  expect(R"(distribution = "half-cauchy", scale = "1500 um")", 0.15278874536821954);
  // dexp(2, 1/4)
  expect(R"(distribution = "exponential", mean = "0.4 cm")", 0.15163266492815836);
  // dgamma(2, 2.5, scale = 3)
  expect(R"(distribution = "gamma", shape = 2.5, scale = "3 mm")", 0.070077080835235075);
  // dgamma(1/2, 2.5, rate = 3)/4
  expect(R"(distribution = "inverse-gamma", shape = 2.5, scale = "3 mm")", 0.23127049470565392);
  // dt((2 - 1)/.5, 4)/.5/pt(2, 4)
  expect(R"(distribution = "student-t", df = 4, location = "1 mm", scale = "0.5 mm")",
         0.14075448203408147);
  // dweibull(2, 1.5, 3)
  expect(R"(distribution = "weibull", scale = "3 mm", shape = 1.5)", 0.23687782228285617);
  // x <- (2/3)^(-.4/.7)/.16; dgamma(x, 1/.16) * x * .4/(.7 * 2)
  expect(R"(distribution = "generalized-gamma", scale = "3 mm", sigma = 0.7, lambda = -0.4)",
         0.23451572025632558);
  // dweibull(2 - .5, 1.5, 3)/(pweibull(4.5, 1.5, 3) - pweibull(.5, 1.5, 3))
  expect(
      R"(distribution = "weibull", scale = "3 mm", shape = 1.5, threshold = "0.5 mm", lower = "1 mm", upper = "5 mm")",
      0.3203592973638173);
  // 1/(2 * log(8))
  expect(R"(distribution = "jeffreys", lower = "1 mm", upper = "8 mm")", 0.24044917348149392);
  // dnorm(2, 3, .5)/(pnorm(4) - pnorm(-3))
  expect(
      R"(distribution = "normal", mean = "3 mm", sd = "0.5 mm", lower = "1.5 mm", upper = "5 mm")",
      0.10813132394103195);
  // dbeta(.3, 2, 5)
  EXPECT_NEAR(
      std::exp(log_density(read(R"(distribution = "beta", alpha = 2, beta = 5)", plain).prior, 0.3)
                   .value),
      2.1608999999999998, 1e-13);
}

TEST_F(PriorTest, UnitIsTheFirstOneWritten) {
  EXPECT_EQ(read(R"(distribution = "normal", mean = "3 mm", sd = "20 um")", length).unit.text,
            "mm");
  EXPECT_EQ(read(R"(distribution = "flat", lower = "0 um")", length).unit.text, "um");
  EXPECT_EQ(read(R"(distribution = "flat", unit = "cm", lower = "0 um")", length).unit.text, "cm");
  EXPECT_EQ(read(R"(distribution = "flat")", plain).unit.text, "1");
  EXPECT_EQ(read(R"(distribution = "jeffreys", unit = "mm")", positive).distribution, "jeffreys");
}

// 30 beside "%" may be 30 or 30 %.
TEST_F(PriorTest, APlainNumberBesideAUnitIsRefused) {
  EXPECT_THAT(refusal(R"(distribution = "half-normal", scale = 30, unit = "%")", plain),
              testing::AllOf(HasSubstr("x.scale: 30 is given beside '%'"), HasSubstr("= 0.3")));
  EXPECT_DOUBLE_EQ(read(R"(distribution = "half-normal", scale = "30 %")", plain).scale,
                   read(R"(distribution = "half-normal", scale = 0.3)", plain).scale);
  const ParameterSpec count{"x", "cycle", 0, infinity, 1};
  EXPECT_THAT(refusal(R"(distribution = "half-normal", scale = 4, unit = "1e3 cycles")", count),
              HasSubstr("= 4000"));
  EXPECT_THAT(refusal(R"(distribution = "normal", mean = "2 Mrev", sd = 3)", count),
              HasSubstr("x.sd: 3"));
  EXPECT_THAT(refusal(R"(distribution = "half-normal", scale = "4 rad")", count),
              HasSubstr("an angle"));
  EXPECT_NO_THROW(
      read(R"(distribution = "normal", mean = "2 Mrev", sd = "3 krev", lower = 0)", count));
  EXPECT_NO_THROW(read(R"(distribution = "half-normal", scale = 4, unit = "turns")", count));
  EXPECT_THAT(refusal(R"(distribution = "half-normal", scale = "4 cycles")", plain),
              HasSubstr("a count"));
}

TEST_F(PriorTest, SupportIsCutByBoundsAndByPhysics) {
  const Parameter cut =
      read(R"(distribution = "normal", mean = "3 mm", sd = "1 mm", lower = "-1 mm")", positive);
  EXPECT_EQ(cut.prior.lower, 0);
  EXPECT_EQ(cut.prior.upper, infinity);
  const Parameter half = read(R"(distribution = "half-normal", scale = "2 mm")", length);
  EXPECT_EQ(half.prior.lower, 0);
  EXPECT_EQ(half.natural_lower, -infinity);
  EXPECT_EQ(
      read(R"(distribution = "half-cauchy", scale = "2 mm", lower = "-5 mm")", length).prior.lower,
      0);
  EXPECT_DOUBLE_EQ(
      read(R"(distribution = "half-cauchy", scale = "2 mm", lower = "1 mm")", length).prior.lower,
      1e-3);
}

TEST_F(PriorTest, StartsInsideItsSupport) {
  EXPECT_EQ(read(R"(distribution = "flat", lower = "0 mm")", length).start, 3e-3);
  for (const char* prior :
       {R"(distribution = "flat", lower = "5 mm")", R"(distribution = "flat", upper = "-5 mm")",
        R"(distribution = "uniform", lower = "5 mm", upper = "6 mm")",
        R"(distribution = "normal", mean = "9 mm", sd = "1 mm", lower = "7 mm")",
        R"(distribution = "half-normal", scale = "1 mm", lower = "20 mm")",
        R"(distribution = "normal", mean = "0 mm", sd = "1 mm", upper = "0 mm")"}) {
    const Parameter p = read(prior, length);
    EXPECT_LT(p.prior.lower, p.start) << prior;
    EXPECT_LT(p.start, p.prior.upper) << prior;
    EXPECT_GT(p.scale, 0) << prior;
    EXPECT_TRUE(std::isfinite(p.scale)) << prior;
  }
}

TEST_F(PriorTest, NamesWhatIsWrong) {
  const auto expect = [&](const std::string& prior, const std::string& what) {
    EXPECT_THAT(refusal(prior, positive), MatchesRegex(".*a.toml:1:[0-9]+: .*")) << prior;
    EXPECT_THAT(refusal(prior, positive), HasSubstr(what)) << prior;
  };
  expect(R"(distribution = "nrmal")", "x.distribution: 'nrmal' is not allowed");
  expect(R"(lower = "0 mm")", "x.distribution: is missing");
  expect(R"(distribution = "flat")", "[x]: no quantity of this prior has a unit");
  expect(R"(distribution = "flat", lower = 0)", "x.lower: 0 has no unit");
  expect(R"(distribution = "flat", lower = "0 s")", "x.lower: unit 's' has the wrong dimension");
  expect(R"(distribution = "flat", unit = "s")", "x.unit: unit 's' has the wrong dimension");
  expect(R"(distribution = "flat", lower = "5 mm", upper = "5 mm")",
         "x.upper: the lower bound 5 is not below the upper bound 5");
  expect(R"(distribution = "flat", lower = "5 mm", upper = "0.2 cm")",
         "x.upper: the lower bound 5 is not below the upper bound 2");
  expect(R"(distribution = "half-normal", scale = "1 mm", upper = "-1 mm")",
         "x.upper: the lower bound 0");
  expect(R"(distribution = "uniform", lower = "0 mm")", "x.upper: is missing");
  expect(R"(distribution = "normal", mean = "3 mm")", "x.sd: is missing");
  expect(R"(distribution = "normal", mean = "3 mm", sd = "0 mm")", "x.sd: must be positive");
  expect(R"(distribution = "lognormal", mean = "-3 mm", sd = "1 mm")", "x.mean: must be positive");
  expect(R"(distribution = "lognormal", median = "-3 mm", log_sd = 1)",
         "x.median: must be positive");
  expect(R"(distribution = "lognormal", median = "0 mm", log_sd = 1)",
         "x.median: must be positive");
  expect(R"(distribution = "lognormal", median = "3 mm", log_sd = -1)",
         "x.log_sd: must be positive");
  expect(R"(distribution = "lognormal", median = "3 mm", mean = "3 mm", log_sd = 1)",
         "x.mean: unknown key");
  expect(R"(distribution = "gamma", shape = -1, scale = "1 mm")", "x.shape: must be positive");
  expect(R"(distribution = "gamma", shape = "2 mm", scale = "1 mm")",
         "x.shape: unit 'mm' has the wrong");
  expect(R"(distribution = "normal", mean = "3 mm", sd = "1 mm", lower = "1 m")", "no probability");
  expect(R"(distribution = "normal", mean = "3 mm", sd = "1 mm", upper = "-1 mm")",
         "0 is not below");
  // Its support is 0 to 1: of metres, or of the user's millimetres?
  expect(R"(distribution = "beta", alpha = 2, beta = 2, unit = "mm")", "only for a plain number");
  EXPECT_THAT(message_of<InputError>([&] {
                read_prior(TomlReader::parse_file(write("b.toml", "y = 1\n")), positive);
              }),
              HasSubstr("no prior for x"));
}

// Degrees Celsius have no mean or scale that converts by a factor.
TEST_F(PriorTest, RefusesUnitsWithAnOffset) {
  const ParameterSpec temperature{"x", "K", 0, infinity, 300};
  for (const char* prior : {R"(distribution = "normal", mean = "20 degC", sd = "1 K")",
                            R"(distribution = "normal", mean = "293 K", sd = "1 degC")",
                            R"(distribution = "uniform", lower = "0 degC", upper = "90 degC")",
                            R"(distribution = "flat", unit = "degC")"}) {
    EXPECT_THAT(refusal(prior, temperature), HasSubstr("has an offset")) << prior;
  }
  EXPECT_EQ(read(R"(distribution = "normal", mean = "293 K", sd = "1 K")", temperature).unit.text,
            "K");
}

// Where the study says nothing, or "default", it is the model's own, and says so.
TEST_F(PriorTest, ADefaultStandsInAndIsCalledOne) {
  ParameterSpec spec = positive;
  spec.fallback = DefaultPrior{"half-normal", HalfNormal{2e-3}, "mm"};
  const auto root = TomlReader::parse_file(write("c.toml", "y = 1\n[prior]\nz = 1\n"));
  const Parameter none = read_prior(root, root.table("prior"), spec);
  EXPECT_TRUE(none.is_default);
  EXPECT_EQ(none.unit.text, "mm");
  EXPECT_EQ(none.distribution, "half-normal");
  EXPECT_NEAR(
      std::exp(log_density(none.prior, 1e-3).value) /
          std::exp(
              log_density(read(R"(distribution = "half-normal", scale = "2 mm")", positive).prior,
                          1e-3)
                  .value),
      1, 1e-12);
  EXPECT_TRUE(read_prior(root, {}, spec).is_default);
  EXPECT_TRUE(read(R"(distribution = "default")", spec).is_default);
  EXPECT_FALSE(read(R"(distribution = "half-normal", scale = "2 mm")", spec).is_default);
  EXPECT_THAT(refusal(R"(distribution = "default")", positive),
              HasSubstr("x has no default prior"));
  EXPECT_THAT(message_of<InputError>([&] { read_prior(root, {}, positive); }),
              HasSubstr("no prior for x"));
}

TEST(RoundedUp, IsOneTwoOrFiveTimesAPowerOfTen) {
  for (const auto& [x, up] : {std::pair{45.31, 50.},
                              {50., 50.},
                              {51., 100.},
                              {1., 1.},
                              {1.1, 2.},
                              {2e-9, 2e-9},
                              {2.1e-9, 5e-9},
                              {9.99e5, 1e6},
                              {0., 0.}})
    EXPECT_NEAR(rounded_up(x), up, 1e-9 * up) << x;
}

}  // namespace
}  // namespace wearwell
