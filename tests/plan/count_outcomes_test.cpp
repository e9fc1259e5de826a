#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>

#include "plan/grid_posterior.h"
#include "wearwell/plan/count_outcomes.h"
#include "wearwell/plan/gain.h"

namespace wearwell::plan {
namespace {

using nlohmann::ordered_json;

// A study of counts with one parameter, and its posterior on an even grid.
Source counts_source(const std::string& columns, const std::string& likelihood,
                     const std::string& prior, const std::vector<Column>& data) {
  Source source{{"counts.toml",
                 "model = \"formula\"\n[data]\nfile = \"counts.csv\"\n"
                 "[data.columns]\nfound = \"found\"\n" +
                     columns + "[likelihood.found]\n" + likelihood + "[prior]\n" + prior}};
  source.tables["counts.csv"] = table_of("counts.csv", data);
  return source;
}

prognosis::CarriedState counts_state(const Source& source, double low, double high) {
  const Posterior posterior = posterior_of(source);
  constexpr int count = 4000;
  WeightedDraws draws;
  draws.values.resize(count, 1);
  Eigen::VectorXd log_weight(count);
  for (int i = 0; i < count; ++i) {
    draws.values(i, 0) = low + (high - low) * (i + 0.5) / count;
    log_weight[i] = posterior.natural_value({draws.values.row(i).data(), 1});
  }
  draws.weights = (log_weight.array() - log_weight.maxCoeff()).exp();
  draws.weights /= draws.weights.sum();
  return state_of(source, draws);
}

double variance_left(const prognosis::CarriedState& state, const std::string& goal,
                     const std::string& grid) {
  NextQuestion question;
  question.goal = goal;
  question.grid = grid;
  question.nodes = 4000;
  return next_test(state, "counts", reading(), question).json["candidates"][0]["variance_left"];
}

// Counts of Poisson with a gamma prior: the posterior is gamma, the predictive distribution is
// negative binomial, and the variance of the logarithm is trigamma.
TEST(CountOutcomes, OfPoissonAreTheClosedForm) {
  const Source source =
      counts_source("area = \"area\"\n", "family = \"poisson\"\nmean = \"rate*area\"\n",
                    "rate = { distribution = \"gamma\", shape = 2, scale = 0.5 }\n",
                    {numbers_column("found", {3, 5, 1}), numbers_column("area", {2, 4, 1})});
  const double shape = 2 + 9, rate = 2 + 7;
  const prognosis::CarriedState state = counts_state(source, 0.01, 5);
  for (const double area : {0.1, 3.0, 50.0, 4000.0}) {
    double expected = 0;
    const int most = static_cast<int>(6 * area + 100);
    for (int y = 0; y <= most; ++y) {
      const double log_p = std::lgamma(shape + y) - std::lgamma(shape) - std::lgamma(y + 1.0) +
                           shape * std::log(rate / (rate + area)) +
                           y * std::log(area / (rate + area));
      expected += std::exp(log_p) * boost::math::trigamma(shape + y);
    }
    expected /= boost::math::trigamma(shape);
    EXPECT_NEAR(variance_left(state, "rate", fmt::format("area = {}", area)), expected,
                0.01 * expected)
        << area;
  }
}

// Of a beta prior and binomial counts: the expected variance of the probability is the present one
// times (a + b) / (a + b + n). Of its logarithm: trigamma(a + y) - trigamma(a + b + n).
TEST(CountOutcomes, OfBinomialAreTheClosedForm) {
  const Source source =
      counts_source("n = \"n\"\n", "family = \"binomial\"\nprobability = \"p\"\ntrials = \"n\"\n",
                    "p = { distribution = \"beta\", alpha = 2, beta = 5 }\n",
                    {numbers_column("found", {1, 0}), numbers_column("n", {10, 4})});
  const double a = 3, b = 5 + 13;
  const prognosis::CarriedState state = counts_state(source, 1e-4, 0.9999);
  const auto log_beta = [](double p, double q) {
    return std::lgamma(p) + std::lgamma(q) - std::lgamma(p + q);
  };
  for (const int n : {1, 5, 40, 2000}) {
    double expected = 0;
    for (int y = 0; y <= n; ++y) {
      const double log_p = std::lgamma(n + 1.0) - std::lgamma(y + 1.0) - std::lgamma(n - y + 1.0) +
                           log_beta(a + y, b + n - y) - log_beta(a, b);
      expected +=
          std::exp(log_p) * (boost::math::trigamma(a + y) - boost::math::trigamma(a + b + n));
    }
    expected /= boost::math::trigamma(a) - boost::math::trigamma(a + b);
    EXPECT_NEAR(variance_left(state, "p", fmt::format("n = {}", n)), expected, 0.01 * expected)
        << n;
  }
}

// A random effect makes the most likely count 0 and the tail long: each count is there.
TEST(CountOutcomes, OfUnitsThatDifferAreAllCounts) {
  Source source = counts_source(
      "area = \"area\"\nrig = \"rig\"\n", "family = \"poisson\"\nmean = \"rate*area\"\n",
      "rate = { distribution = \"gamma\", shape = 2, scale = 0.5 }\n"
      "s = { distribution = \"half-normal\", scale = 0.5 }\n"
      "[random_effects.rig]\nrate = { distribution = \"lognormal\", log_sd = \"s\" }\n",
      {numbers_column("found", {3, 4, 1, 3, 5}),
       numbers_column("area", {20, 30, 20, 40, 25}),
       {"rig", false, {}, {"rig A", "rig A", "rig B", "rig B", "rig C"}}});
  const TestStudy study = test_study(source, reading());
  const Table conditions =
      table_of("asked", {numbers_column("area", {20}), {"rig", false, {}, {""}}});
  const PlannedTest tests[] = {{0, {}}};
  Points nodes(3, 2);
  nodes << 0.05, 0.2, 0.1, 0.8, 0.2, 1.5;
  const double weights[] = {0.3, 0.4, 0.3};
  const Outcomes found = count_outcomes(study, conditions, tests, nodes, weights)[0];
  EXPECT_LT(found.defect, 1e-3);
  for (std::size_t m = 0; m < 10; ++m) EXPECT_EQ(found.value[m], static_cast<double>(m));
  // Mean of exp(-20 rate exp(s z)) over a standard normal z.
  double none = 0;
  for (double z = -8; z < 8; z += 0.01)
    none += 0.01 * std::exp(-0.5 * z * z - 20 * 0.1 * std::exp(0.8 * z)) / std::sqrt(2 * M_PI);
  EXPECT_NEAR(std::exp(static_cast<double>(found.log_probability(1, 0))), none, 1e-3);
}

// Blocks of counts stand for all of them: probabilities, mean and variance of a wide distribution.
TEST(CountOutcomes, BlocksKeepMeanAndVariance) {
  const Source source =
      counts_source("area = \"area\"\n", "family = \"poisson\"\nmean = \"rate*area\"\n",
                    "rate = { distribution = \"gamma\", shape = 2, scale = 0.5 }\n",
                    {numbers_column("found", {3, 5, 1}), numbers_column("area", {2, 4, 1})});
  const TestStudy study = test_study(source, reading());
  const Table conditions = table_of("asked", {numbers_column("area", {1e5})});
  const PlannedTest tests[] = {{0, {}}};
  Points nodes(3, 1);
  nodes << 0.2, 1, 3;
  const double weights[] = {0.2, 0.5, 0.3};
  const Outcomes found = count_outcomes(study, conditions, tests, nodes, weights)[0];
  EXPECT_LT(found.size(), 3000u);
  EXPECT_LT(found.defect, 1e-4);
  for (int j = 0; j < 3; ++j) {
    double mean = 0, squares = 0;
    for (std::size_t m = 0; m < found.size(); ++m) {
      const double p =
          std::exp(static_cast<double>(found.log_probability(j, static_cast<Eigen::Index>(m))));
      mean += p * found.value[m];
      squares += p * found.value[m] * found.value[m];
    }
    const double expected = 1e5 * nodes(j, 0);
    EXPECT_NEAR(mean, expected, 0.02 * std::sqrt(expected));
    EXPECT_NEAR(squares - mean * mean, expected, 0.03 * expected);
    for (const double u : {0.01, 0.5, 0.99}) {
      const double drawn = found.drawn(j, u, false).value;
      EXPECT_EQ(drawn, std::round(drawn));
    }
  }
}

}  // namespace
}  // namespace wearwell::plan
