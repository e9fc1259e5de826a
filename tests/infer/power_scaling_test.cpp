#include "wearwell/infer/power_scaling.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

using boost::math::normal;

/// Prior N(m, s) and a likelihood that is N(y, t) in theta: prior^a * likelihood^b is normal.
struct Conjugate {
  double m, s, y, t;

  normal posterior(double a, double b) const {
    const double prior = a / (s * s), data = b / (t * t);
    return normal((prior * m + data * y) / (prior + data), 1 / std::sqrt(prior + data));
  }
  double log_prior(double theta) const { return -0.5 * std::pow((theta - m) / s, 2); }
  double log_likelihood(double theta) const { return -0.5 * std::pow((theta - y) / t, 2); }
};

/// The cumulative Jensen-Shannon distance as printed, by quadrature over the exact distribution
/// functions. Its normalization depends on how far the draws reach, so the range is theirs.
double exact_distance(const normal& p, const normal& q, double low, double high) {
  using boost::math::complement;
  const auto term = [](double f, double g) {
    return f == 0 ? 0 : f * std::log2(f / (0.5 * (f + g)));
  };
  const auto integrate = [&](auto f) {
    double sum = 0;
    for (int i = 0; i < 20; ++i) {
      const double step = (high - low) / 20;
      sum += boost::math::quadrature::gauss_kronrod<double, 61>::integrate(f, low + i * step,
                                                                           low + (i + 1) * step, 0);
    }
    return sum;
  };
  const auto side = [&](auto f, auto g) {
    return integrate([&](double x) { return term(f(x), g(x)) + term(g(x), f(x)); }) /
           integrate([&](double x) { return f(x) + g(x); });
  };
  const double left =
      side([&](double x) { return cdf(p, x); }, [&](double x) { return cdf(q, x); });
  const double right = side([&](double x) { return cdf(complement(p, x)); },
                            [&](double x) { return cdf(complement(q, x)); });
  return std::sqrt(std::max(left, right));
}

PowerScaling exact_sensitivity(const Conjugate& model, double low, double high) {
  PowerScaling sensitivity{0, 0};
  const normal base = model.posterior(1, 1);
  for (const double alpha : {0.99, 1.01}) {
    const double per = 2 * std::abs(std::log2(alpha));
    sensitivity.prior += exact_distance(base, model.posterior(alpha, 1), low, high) / per;
    sensitivity.likelihood += exact_distance(base, model.posterior(1, alpha), low, high) / per;
  }
  return sensitivity;
}

struct Draws {
  std::vector<double> theta, log_prior, log_likelihood;
};

Draws with_densities(const Conjugate& model, std::vector<double> theta) {
  Draws draws{std::move(theta), {}, {}};
  for (const double x : draws.theta) {
    draws.log_prior.push_back(model.log_prior(x));
    draws.log_likelihood.push_back(model.log_likelihood(x));
  }
  return draws;
}

/// Draws without noise: evenly spaced quantiles of the posterior.
Draws even_draws(const Conjugate& model, int count) {
  std::vector<double> theta;
  for (int i = 0; i < count; ++i) {
    theta.push_back(quantile(model.posterior(1, 1), (i + 0.5) / count));
  }
  return with_densities(model, theta);
}

PowerScaling estimate(const Draws& draws) {
  return power_scaling(draws.theta, draws.log_prior, draws.log_likelihood);
}

TEST(PowerScaling, OfConjugateNormalIsTheExactOne) {
  for (const Conjugate& model :
       {Conjugate{0, 1, 0, 1}, Conjugate{0, 2.5, 5, 1}, Conjugate{0, 1, 5, 0.3},
        Conjugate{1, 0.5, 1.2, 3}, Conjugate{-3, 1, 4, 1}, Conjugate{0, 100, 3, 1}}) {
    const Draws draws = even_draws(model, 20'000);
    const PowerScaling exact = exact_sensitivity(model, draws.theta.front(), draws.theta.back());
    const PowerScaling estimated = estimate(draws);
    EXPECT_NEAR(estimated.prior, exact.prior, 1e-3 * exact.prior);
    EXPECT_NEAR(estimated.likelihood, exact.likelihood, 1e-3 * exact.likelihood);
  }
}

// As a sampler would give them: 4000 random draws, within the noise.
TEST(PowerScaling, OfRandomDrawsIsNearTheExactOne) {
  const Conjugate model{0, 2.5, 5, 1};
  const normal posterior = model.posterior(1, 1);
  Rng rng(11, 0);
  std::vector<double> theta;
  for (int i = 0; i < 4000; ++i) {
    theta.push_back(posterior.mean() + posterior.standard_deviation() * rng.normal());
  }
  const auto [low, high] = std::minmax_element(theta.begin(), theta.end());
  const PowerScaling exact = exact_sensitivity(model, *low, *high);
  const PowerScaling estimated = estimate(with_densities(model, theta));
  EXPECT_NEAR(estimated.prior, exact.prior, 0.05 * exact.prior);
  EXPECT_NEAR(estimated.likelihood, exact.likelihood, 0.05 * exact.likelihood);
}

TEST(PowerScaling, RisesWithConflict) {
  PowerScaling last{0, 0};
  for (const double data : {0.5, 1., 2., 4., 8.}) {
    const PowerScaling now = estimate(even_draws({0, 1, data, 0.5}, 4000));
    EXPECT_GT(now.prior, last.prior) << data;
    EXPECT_GT(now.likelihood, last.likelihood) << data;
    last = now;
  }
}

TEST(PowerScaling, OfFlatPriorIsZero) {
  Draws draws = even_draws({0, 1, 2, 0.5}, 1000);
  std::fill(draws.log_prior.begin(), draws.log_prior.end(), -3.7);
  EXPECT_EQ(estimate(draws).prior, 0);
  EXPECT_GT(estimate(draws).likelihood, 0.05);
}

TEST(PowerScaling, TellsConflictFromStrongPrior) {
  using enum PowerScalingVerdict;
  EXPECT_EQ(verdict(estimate(even_draws({0, 1, 5, 1}, 4000))), prior_data_conflict);
  EXPECT_EQ(verdict(estimate(even_draws({0, 1, 1, 20}, 4000))), strong_prior_or_weak_likelihood);
  EXPECT_EQ(verdict(estimate(even_draws({0, 20, 1, 1}, 4000))), none);
  EXPECT_EQ(verdict({0.05, 0.05}), prior_data_conflict);
  EXPECT_EQ(verdict({0.05, 0.049}), strong_prior_or_weak_likelihood);
  EXPECT_EQ(verdict({0.049, 0.9}), none);
  EXPECT_EQ(verdict({0.049, 0.01}), none);
  EXPECT_EQ(verdict({std::nan(""), 0.9}), unknown);
}

TEST(PowerScaling, OfWhatIsNotFiniteOrConstantIsUnknown) {
  const std::vector<double> x{1, 2, 3}, log{-1, -2, -1};
  const std::vector<double> infinite{-1, -HUGE_VAL, -1};
  EXPECT_TRUE(std::isnan(power_scaling_sensitivity(x, infinite)));
  EXPECT_TRUE(std::isnan(power_scaling_sensitivity(infinite, log)));
  EXPECT_TRUE(std::isnan(power_scaling_sensitivity(std::vector<double>{2, 2, 2}, log)));
  EXPECT_TRUE(std::isnan(power_scaling_sensitivity(x, log, std::vector<double>{0, 0, 0})));
  EXPECT_TRUE(std::isnan(power_scaling_sensitivity({}, {})));
  EXPECT_TRUE(std::isnan(power_scaling(x, infinite, log).prior));
  EXPECT_FALSE(std::isnan(power_scaling(x, infinite, log).likelihood));
  EXPECT_THROW(power_scaling_sensitivity(x, std::vector<double>{1, 2}), std::invalid_argument);
  EXPECT_THROW(power_scaling_sensitivity(x, log, std::vector<double>{1, 2}), std::invalid_argument);
}

// By hand. Weights (1/2, 1/2) and (1, 0) on two draws: P = 1/2, Q = 1 between them, or from the
// other side P = 1/2, Q = 0, where the distance is at its bound of 1. Weights (1/4, 1/4, 1/2) and
// (1/2, 1/4, 1/4) on -1, 0, 2 from either side:
// P = 1/4, 1/2 and Q = 1/2, 3/4 over widths 1 and 2, or P = 1/2, 3/4 and Q = 1/4, 1/2 over 2 and 1.
TEST(CumulativeJensenShannon, IsTheIntegralOverSteps) {
  EXPECT_DOUBLE_EQ(
      cumulative_jensen_shannon(std::vector<double>{0, 1}, std::vector<double>{0.5, 0.5},
                                std::vector<double>{1, 0}),
      1);
  const auto js = [](double p, double q) {
    return p * std::log2(2 * p / (p + q)) + q * std::log2(2 * q / (p + q));
  };
  const double left = (1 * js(0.25, 0.5) + 2 * js(0.5, 0.75)) / (1 * 0.75 + 2 * 1.25);
  const double right = (2 * js(0.5, 0.25) + 1 * js(0.75, 0.5)) / (2 * 0.75 + 1 * 1.25);
  EXPECT_NEAR(cumulative_jensen_shannon(std::vector<double>{-1, 0, 2}, std::vector<double>{1, 1, 2},
                                        std::vector<double>{2, 1, 1}),
              std::sqrt(std::max(left, right)), 1e-15);
  EXPECT_EQ(cumulative_jensen_shannon(std::vector<double>{0, 1}, std::vector<double>{0, 1},
                                      std::vector<double>{0, 2}),
            0);
}

RC_GTEST_PROP(PowerScaling, IsInvariantUnderUnitsConstantsAndOrder, ()) {
  Rng rng(*rc::gen::inRange<std::uint64_t>(0, 1'000'000), 0);
  const auto count = *rc::gen::inRange<std::size_t>(2, 200);
  const double scale = *rc::gen::element(-3., 1e-12, 7e5), shift = *rc::gen::element(0., 2.5);
  std::vector<double> draws, log_prior, moved, raised;
  for (std::size_t i = 0; i < count; ++i) {
    draws.push_back(rng.normal());
    log_prior.push_back(-std::abs(draws[i] - 1));
  }
  for (std::size_t i = count; i-- > 0;) {
    moved.push_back(scale * (draws[i] + shift));
    raised.push_back(log_prior[i] + 1e4);
  }
  const double a = power_scaling_sensitivity(draws, log_prior);
  const double b = power_scaling_sensitivity(moved, raised);
  RC_ASSERT(std::abs(a - b) <= 1e-6 * a);
}

RC_GTEST_PROP(PowerScaling, TakesWholeWeightsForRepeatedDraws, ()) {
  Rng rng(*rc::gen::inRange<std::uint64_t>(0, 1'000'000), 0);
  std::vector<double> draws, log_prior, weights, repeated, repeated_log;
  for (int i = 0; i < 50; ++i) {
    // The ends have weight: they are the range that the distance is normalized by.
    const bool end = i < 2;
    draws.push_back(end ? 20 * i - 10 : rng.normal());
    log_prior.push_back(-draws.back() * draws.back());
    weights.push_back(*rc::gen::inRange(end ? 1 : 0, 4));
    for (int k = 0; k < weights.back(); ++k) {
      repeated.push_back(draws.back());
      repeated_log.push_back(log_prior.back());
    }
  }
  const double a = power_scaling_sensitivity(draws, log_prior, weights);
  const double b = power_scaling_sensitivity(repeated, repeated_log);
  RC_ASSERT(std::abs(a - b) <= 1e-9 * a);
}

}  // namespace
}  // namespace wearwell
