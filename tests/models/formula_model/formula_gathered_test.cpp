// Long tables: rows under equal conditions are gathered. Against sums over all rows, the other sampler, and large-sample theory.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/rng.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

class FormulaGathered : public ScratchTest {
 protected:
  static constexpr double scale = 1000, shape = 2;

  // Weibull lives at three temperatures that do not matter; of censored ones three in ten were stopped at times of their own.
  void simulate(int count, bool censored, std::uint64_t seed) const {
    Rng rng(seed, 0);
    const double latest = scale * std::tgamma(1 + 1 / shape) / 0.3;
    std::string text = "hours,status,T\n";
    for (int i = 0; i < count; ++i) {
      const double life = scale * std::pow(-std::log(rng.uniform()), 1 / shape);
      const double stop = censored ? latest * rng.uniform() : INFINITY;
      text += fmt::format("{:.9g},{},{}\n", std::min(life, stop),
                          life <= stop ? "failure" : "runout", 20 * (1 + i % 3));
    }
    write("lives.csv", text);
  }

  PosteriorStudy study(const std::string& by_temperature = "") const {
    return read_posterior_study(write(
        "study.toml",
        fmt::format(
            R"(
title = "Many lives"
model = "formula"
[data]
file = "lives.csv"
[data.columns]
life = {{ column = "hours", unit = "h" }}
status = "status"
T = {{ column = "T", unit = "1" }}
[likelihood.life]
family = "weibull"
scale = "characteristic{0}"
shape = "slope"
[prior]
characteristic = {{ distribution = "lognormal", median = "2000 h", log_sd = 1 }}
slope = {{ distribution = "lognormal", median = 2, log_sd = 0.7 }}
{1}
[predict]
{2}
b_lives = [1, 10]
)",
            by_temperature,
            by_temperature.empty() ? "" : "c = { distribution = \"normal\", mean = 0, sd = 1 }",
            by_temperature.empty() ? "" : "given = { T = 40 }")));
  }
};

double sum_over_rows(const LogDensity& likelihood, std::span<const double> x) {
  double sum = 0;
  for (const double each : likelihood.pointwise(x)) sum += each;
  return sum;
}

TEST_F(FormulaGathered, SumsAreThoseOverAllRows) {
  simulate(20'000, true, 1);
  const PosteriorStudy by_temperature = study("*exp(c*(T - 40)/100)");
  const auto likelihood = by_temperature.likelihood(20'000);
  for (const std::vector<double>& x :
       {std::vector<double>{3.6e6, 2, 0}, {3.0e6, 1.2, 0.5}, {5e6, 3.5, -0.7}}) {
    const double truth = sum_over_rows(*likelihood, x);
    EXPECT_NEAR(likelihood->value(x), truth, 1e-11 * std::abs(truth));
    std::vector<double> gradient(3), moved = x;
    EXPECT_NEAR(likelihood->value_and_gradient(x, gradient), truth, 1e-11 * std::abs(truth));
    for (std::size_t i = 0; i < 3; ++i) {
      const double size = std::max(std::abs(x[i]), 1.0), step = 1e-4 * size;
      moved[i] = x[i] + step;
      const double above = sum_over_rows(*likelihood, moved);
      moved[i] = x[i] - step;
      const double change = (above - sum_over_rows(*likelihood, moved)) / (2 * step) * size;
      moved[i] = x[i];
      EXPECT_NEAR(gradient[i] * size, change, 1e-4 * std::abs(change) + 0.01) << i;
    }
  }
}

// The same numbers by two ways that share the likelihood alone.
TEST_F(FormulaGathered, DrawsOfQuadratureAndOfNutsAgree) {
  simulate(30'000, true, 2);
  const PosteriorStudy lives = study();
  SamplerChoice exact, nuts;
  exact.method = Method::exact;
  nuts.method = Method::nuts;
  const PosteriorSummary by_quadrature = run_study(lives, exact), by_nuts = run_study(lives, nuts);
  EXPECT_TRUE(by_quadrature.trusted);
  EXPECT_TRUE(by_nuts.trusted);
  for (std::size_t i = 0; i < 2; ++i) {
    const QuantityDistribution &a = by_quadrature.fit->marginals[i], &b = by_nuts.fit->marginals[i];
    EXPECT_NEAR(a.mean(), b.mean(), 1e-9 * a.mean());
    const auto column = static_cast<Eigen::Index>(i);
    const double sd = by_quadrature.fit->exact->sd[column];
    for (const Fit* fit : {by_quadrature.fit.get(), by_nuts.fit.get()}) {
      const Diagnostics& drawn = fit->diagnostics[i];
      const Eigen::VectorXd values = fit->pooled.values.col(column);
      EXPECT_NEAR(values.mean(), a.mean(), 4 * drawn.mcse_mean);
      const double own = std::sqrt((values.array() - values.mean()).square().mean());
      EXPECT_NEAR(own / sd, 1, 4 / std::sqrt(2 * drawn.ess_bulk) + 0.01);
    }
  }
}

TEST_F(FormulaGathered, RightLivesAreTrustedWhateverTheSeed) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    simulate(20'000, seed % 2 == 0, 10 + seed);
    SamplerChoice choice;
    choice.seed = seed;
    const PosteriorSummary result = run_study(study(), choice);
    for (const Check& check : result.checks)
      EXPECT_NE(check.verdict, Verdict::fail) << seed << " " << check.name << " " << check.detail;
  }
}

// Of n lives without run-outs the standard deviations are 1.0530 scale/(shape root n) and 0.7797 shape/root n
// (Cohen 1965, Technometrics 7, 579-588; of the inverse of Fisher's information, 1.1087 and 0.6079).
TEST_F(FormulaGathered, TendsToTheNormalDistributionOfLargeSamples) {
  constexpr int count = 100'000;
  simulate(count, false, 3);
  SamplerChoice exact;
  exact.method = Method::exact;
  const PosteriorSummary result = run_study(study(), exact);
  ASSERT_TRUE(result.fit->exact);
  const Eigen::VectorXd &sd = result.fit->exact->sd, &mean = result.fit->exact->mean;
  const double root = std::sqrt(static_cast<double>(count));
  EXPECT_NEAR(sd[0] / (std::sqrt(1.1087) * mean[0] / mean[1] / root), 1, 0.01);
  EXPECT_NEAR(sd[1] / (std::sqrt(0.6079) * mean[1] / root), 1, 0.01);
  EXPECT_NEAR(mean[1], shape, 4 * sd[1]);
  EXPECT_NEAR(mean[0], 3600 * scale, 4 * sd[0]);
  ASSERT_TRUE(result.mode);
}

}  // namespace
}  // namespace wearwell
