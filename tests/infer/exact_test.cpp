#include "wearwell/infer/exact.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "infer/test_posteriors.h"
#include "wearwell/infer/mode.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/view.h"
#include "wearwell/prob/lognormal.h"

namespace wearwell {
namespace {

ExactPosterior integrated(const Posterior& posterior) {
  return integrate(posterior, whitening_at(find_mode(posterior, posterior.start())));
}

class ExactOnKnown : public testing::TestWithParam<KnownPosterior> {};

TEST_P(ExactOnKnown, MomentsAndMedian) {
  const KnownPosterior& known = GetParam();
  const Posterior posterior = known.make();
  if (posterior.dimension() > max_exact_dimension)
    GTEST_SKIP() << "more parameters than quadrature reaches";
  const ExactPosterior exact = integrated(posterior);
  ASSERT_EQ(exact.failure, "");
  for (int i = 0; i < posterior.dimension(); ++i) {
    EXPECT_NEAR(exact.mean[i], known.mean[i], 1e-5 * (known.sd[i] + std::abs(known.mean[i])));
    EXPECT_NEAR(exact.sd[i], known.sd[i], 2e-4 * known.sd[i]);
    const QuantityDistribution marginal(exact.nodes, [i](const double* x) { return x[i]; });
    // The cells of four parameters are coarser (lattice.h).
    const double cells = posterior.dimension() == 4 ? 0.01 : 1e-3;
    EXPECT_NEAR(marginal.mean(), known.mean[i], cells * known.sd[i]);
    if (!known.median.empty()) {
      EXPECT_NEAR(marginal.quantile(0.5), known.median[i], 2 * cells * known.sd[i]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, ExactOnKnown, testing::ValuesIn(known_posteriors()),
                         [](const auto& each) { return each.param.name; });

// tests/golden/joint_grid.R: a dense grid in R, to six digits.
TEST(Exact, AllSixteenJointPosteriors) {
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/joint_grid.csv");
  std::string line;
  std::getline(file, line);
  int compared = 0;
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    const bool lognormal = cells[0] == "lognormal";
    const Posterior posterior = joint_posterior(lognormal, cells[1] == "tribometer",
                                                lognormal ? 7 : 15, std::stoul(cells[2]));
    const ExactPosterior exact = integrated(posterior);
    ASSERT_EQ(exact.failure, "") << line;
    EXPECT_NEAR(exact.mean[0] * 1e13, std::stod(cells[4]), 2e-5 * std::stod(cells[4])) << line;
    EXPECT_NEAR(exact.sd[0] * 1e13, std::stod(cells[5]), 1e-4 * std::stod(cells[5])) << line;
    EXPECT_NEAR(exact.mean[1] * 1e9, std::stod(cells[6]), 2e-5 * std::stod(cells[6])) << line;
    EXPECT_NEAR(exact.sd[1] * 1e9, std::stod(cells[7]), 1e-4 * std::stod(cells[7])) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 20);
}

// tests/golden/joint_quantiles.py: nested Gauss-Legendre rules. After one inspection the posterior opens
// like a funnel, and a tenth of the mass lies where k is known a hundred times better than in the middle.
TEST(Exact, QuantilesOfJointPosteriorsIntoTheTails) {
  std::ifstream file(PROJECT_SOURCE_DIR "/tests/golden/joint_quantiles.csv");
  std::string line;
  std::getline(file, line);
  int compared = 0;
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    const bool lognormal = cells[0] == "lognormal";
    const Posterior posterior =
        joint_posterior(lognormal, false, lognormal ? 7 : 15, std::stoul(cells[1]));
    const ExactPosterior exact = integrated(posterior);
    ASSERT_EQ(exact.failure, "") << line;
    EXPECT_LE(exact.error, 1e-5) << line;
    const int i = cells[2] == "sigma";
    const double unit = i ? 1e9 : 1e13;
    const QuantityDistribution marginal(exact.nodes, [=](const double* x) { return x[i] * unit; });
    EXPECT_NEAR(exact.mean[i] * unit, std::stod(cells[3]), 2e-5 * std::stod(cells[3])) << line;
    const double probabilities[] = {0.01, 0.05, 0.5, 0.95, 0.99};
    const double sd = exact.sd[i] * unit;
    for (std::size_t q = 0; q < 5; ++q) {
      const double tolerance = (q == 0 || q == 4 ? 6e-3 : 2e-3) * sd;
      EXPECT_NEAR(marginal.quantile(probabilities[q]), std::stod(cells[4 + q]), tolerance) << line;
    }
    ++compared;
  }
  EXPECT_EQ(compared, 20);
}

// The evidence of a normal mean with a normal prior is a normal density: y ~ N(mu, 1), mu ~ N(0,
// 2), y = 1.5.
TEST(Exact, EvidenceOfConjugateNormal) {
  class Likelihood final : public LogDensity {
   public:
    int dimension() const override { return 1; }
    double value(std::span<const double> x) const override {
      return -0.5 * std::pow(1.5 - x[0], 2) - 0.5 * std::log(2 * M_PI);
    }
    double value_and_gradient(std::span<const double> x,
                              std::span<double> gradient) const override {
      gradient[0] = 1.5 - x[0];
      return value(x);
    }
  };
  Parameter mean = flat_parameter("mu", 0.1, 1);
  mean.prior = make_distribution(Normal{0, 2}, -INFINITY, INFINITY);
  const ExactPosterior exact = integrated(Posterior({mean}, std::make_shared<Likelihood>()));
  ASSERT_TRUE(exact.log_evidence.has_value());
  EXPECT_NEAR(*exact.log_evidence, -0.5 * 1.5 * 1.5 / 5 - 0.5 * std::log(2 * M_PI * 5), 1e-6);
  EXPECT_FALSE(integrated(joint_posterior(false, false, 15, 5)).log_evidence.has_value())
      << "a flat prior has no evidence";
}

// With three data sets and no bound on sigma the mean of k does not exist; with four the standard
// deviation does not.
TEST(Exact, SaysWhenItDoesNotConverge) {
  const Posterior improper = joint_posterior(false, false, INFINITY, 2);
  EXPECT_NE(integrated(improper).failure, "");
  const ExactPosterior no_variance = integrated(joint_posterior(false, false, INFINITY, 4));
  EXPECT_TRUE(std::isnan(no_variance.sd[0]));
}

// Three failures and two run-outs of a Weibull distribution.
class FewLives final : public LogDensity {
 public:
  int dimension() const override { return 2; }
  double value(std::span<const double> x) const override {
    double gradient[2];
    return value_and_gradient(x, gradient);
  }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    double sum = 0;
    gradient[0] = gradient[1] = 0;
    for (const auto& [life, failed] : {std::pair(5100., true),
                                       {9500., false},
                                       {15000., true},
                                       {22000., false},
                                       {40000., true}}) {
      const double log_ratio = std::log(life / x[0]), power = std::exp(x[1] * log_ratio);
      sum += (failed ? std::log(x[1]) + x[1] * log_ratio - std::log(life) : 0) - power;
      gradient[0] += x[1] / x[0] * (power - (failed ? 1 : 0));
      gradient[1] += (failed ? 1 / x[1] + log_ratio : 0) - log_ratio * power;
    }
    return sum;
  }
};

// Towards a shape of 0 the mean life grows faster than any parabola follows: it was -3.8e10 h.
TEST(Exact, MeanOfAPositiveQuantityIsPositive) {
  Parameter scale = flat_parameter("scale", 20000, 20000), shape = flat_parameter("shape", 1.5, 1);
  scale.prior = make_distribution(Lognormal{50000, 2}, 0, infinity);
  shape.prior = make_distribution(Lognormal{1.5, 0.7}, 0, infinity);
  const ExactPosterior exact = integrated(Posterior({scale, shape}, std::make_shared<FewLives>()));
  ASSERT_EQ(exact.failure, "");
  const QuantityDistribution mean_life(
      exact.nodes, [](const double* x) { return x[0] * std::tgamma(1 + 1 / x[1]); });
  EXPECT_GT(mean_life.mean(), mean_life.quantile(0.5));
}

TEST(Exact, IndependentDrawsFollowThePosterior) {
  const Posterior posterior = joint_posterior(false, false, 15, 5);
  const ExactPosterior exact = integrated(posterior);
  const Draws draws = independent_draws(posterior, exact, 4, 5000, 3, 0);
  for (int i = 0; i < 2; ++i) {
    const QuantityDistribution marginal(exact.nodes, [i](const double* x) { return x[i]; });
    // Kolmogorov-Smirnov with 20,000 independent draws: 1.95/sqrt(n) is exceeded with probability
    // 0.1 %.
    std::vector<double> all;
    for (const Chain& chain : draws)
      all.insert(all.end(), chain.values.col(i).begin(), chain.values.col(i).end());
    std::sort(all.begin(), all.end());
    double distance = 0;
    for (std::size_t n = 0; n < all.size(); n += 50) {
      const double empirical = (static_cast<double>(n) + 0.5) / static_cast<double>(all.size());
      distance = std::max(distance, std::abs(marginal.cdf(all[n]) - empirical));
    }
    EXPECT_LT(distance, 1.95 / std::sqrt(static_cast<double>(all.size())));
  }
}

}  // namespace
}  // namespace wearwell
