// Lives of two results (lives_against.h) against the closed forms of exponential lives.
#include <gtest/gtest.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/prognosis/lives_against.h"

namespace wearwell::prognosis {
namespace {

// Exponential lives whose rate has a gamma posterior: its quantiles, equally weighted. A `share` of the items can fail
// at all.
struct ExponentialLives {
  WeightedDraws posterior;
  QuantityGroup group;
  QuantityRequest request;

  ExponentialLives(double shape, double failures_per_use, double share = 1) {
    constexpr int count = 4000;
    const boost::math::gamma_distribution<> rate(shape, 1 / failures_per_use);
    posterior.values.resize(count, 1);
    for (int i = 0; i < count; ++i)
      posterior.values(i, 0) = boost::math::quantile(rate, (i + 0.5) / count);
    posterior.weights = Eigen::VectorXd::Constant(count, 1.0 / count);
    group.lives = [share](const WeightedDraws& draws) {
      const double at = draws.values(0, 0);
      PredictiveLife life;
      life.distribution.cdf = [=](double t) { return -share * std::expm1(-at * t); };
      life.distribution.quantile = [=](double p) {
        return p < share ? -std::log1p(-p / share) / at : infinity;
      };
      return std::vector<PredictiveLife>{life};
    };
  }
  LifeOfResult life() const { return {{&group, &request, 0}, posterior}; }
};

TEST(LivesAgainst, ExponentialLivesHaveTheClosedForm) {
  const ExponentialLives a(12, 24000), b(8, 8000);  // rates of about 1/2000 and 1/1000
  const LivesAgainst found = lives_against(a.life(), b.life(), 0.95, 500.0);
  // Ratio of B-lives = rate of b / rate of a = (8/8000)/(12/24000) times an F variate with 16 and 24 degrees of freedom.
  const boost::math::fisher_f_distribution<> f(16, 24);
  ASSERT_EQ(found.ratios.size(), 3u);
  for (const auto& [percent, ratio] : found.ratios) {
    EXPECT_NEAR(ratio.q05, 2 * boost::math::quantile(f, 0.05), 0.01 * ratio.q05) << percent;
    EXPECT_NEAR(ratio.q50, 2 * boost::math::quantile(f, 0.5), 0.01 * ratio.q50) << percent;
    EXPECT_NEAR(ratio.q95, 2 * boost::math::quantile(f, 0.95), 0.01 * ratio.q95) << percent;
    EXPECT_EQ(ratio.lower, ratio.q05);
    EXPECT_NEAR(ratio.larger, boost::math::cdf(complement(f, 0.5)), 0.003);
  }
  // P(a outlives b) = r/(1 + r) for a ratio r.
  const auto share = [](double r) { return r / (1 + r); };
  EXPECT_NEAR(found.outlives.q05, share(2 * boost::math::quantile(f, 0.05)), 0.004);
  EXPECT_NEAR(found.outlives.q50, share(2 * boost::math::quantile(f, 0.5)), 0.004);
  EXPECT_NEAR(found.outlives.larger, boost::math::cdf(complement(f, 0.5)), 0.003);
  // Mean difference of survival at 500: Laplace transforms of the gamma posteriors.
  ASSERT_TRUE(found.survival);
  EXPECT_NEAR(found.survival->mean, std::pow(24000 / 24500.0, 12) - std::pow(8000 / 8500.0, 8),
              1e-4);
}

TEST(LivesAgainst, OneLifeAgainstItselfIsEven) {
  const ExponentialLives a(5, 5000);
  const LivesAgainst found = lives_against(a.life(), a.life(), 0.9, {});
  EXPECT_NEAR(found.outlives.mean, 0.5, 1e-4);
  EXPECT_NEAR(found.outlives.larger, 0.5, 5e-3);
  for (const auto& each : found.ratios) EXPECT_NEAR(each.of.larger, 0.5, 1e-9);
  EXPECT_FALSE(found.survival);
}

// Of two that may never fail, ties count by half; B-lives that neither reaches have no ratio.
TEST(LivesAgainst, LivesThatNeverEndAreEqual) {
  const ExponentialLives a(50, 50000, 0.3), b(50, 50000, 0.3);
  const LivesAgainst found = lives_against(a.life(), b.life(), 0.9, {});
  EXPECT_NEAR(found.outlives.mean, 0.5, 1e-4);
  ASSERT_EQ(found.ratios.size(), 2u);  // B1 and B10
  EXPECT_EQ(found.ratios[1].percent, 10);
}

}  // namespace
}  // namespace wearwell::prognosis
