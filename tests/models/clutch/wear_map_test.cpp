#include "wearwell/models/clutch/wear_map.h"

#include <gmock/gmock.h>

#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell::clutch {
namespace {

using testing::ElementsAre;

WearPoints random_points(int count, std::uint64_t seed) {
  Rng rng(seed, 0);
  WearPoints points;
  points.w.resize(count);
  points.cycles = Eigen::VectorXd::Constant(count, 1000);
  points.balance_sd = Eigen::VectorXd::Zero(count);
  for (int j = 0; j < count; ++j) {
    points.number.push_back(j + 1);
    points.at.push_back(
        {rng.uniform(120, 300), rng.uniform(25, 75), rng.uniform(120, 240), rng.uniform(0.9, 3.4)});
    const OperatingPoint& at = points.at.back();
    const double ds = std::pow(at.slip_speed, 0.8) * std::pow(at.closing_time, 0.4) / 100;
    points.w[j] = (5 + 8 * ds * at.torque / 50 - 3 * ds * ds + 2 * rng.normal()) * mm3_per_MJ;
  }
  return points;
}

TEST(SurrogateInput, IsWhatItsNameSays) {
  const std::vector<OperatingPoint> at = {{200, 50, 170, 2}};
  EXPECT_THAT(input_names(Surrogate::distance), ElementsAre("ds", "Td", "Mz"));
  const Eigen::MatrixXd ds = input_values(Surrogate::distance, 1.5, 0.5, at);
  EXPECT_DOUBLE_EQ(ds(0, 0), std::pow(200, 1.5) * std::sqrt(2.0));
  EXPECT_EQ(ds(0, 1), 170);
  EXPECT_EQ(ds(0, 2), 50);
  EXPECT_THAT(input_names(Surrogate::power), ElementsAre("ps", "Td", "t2"));
  const Eigen::MatrixXd ps = input_values(Surrogate::power, 1.5, 0.5, at);
  EXPECT_DOUBLE_EQ(ps(0, 0), std::pow(200, 1.5) * std::sqrt(50.0));
  EXPECT_EQ(ps(0, 2), 2);
  EXPECT_THAT(input_names(Surrogate::energy), ElementsAre("es", "Td"));
  EXPECT_DOUBLE_EQ(input_values(Surrogate::energy, 1, 1, at)(0, 0), 200 * 2 * 50);
}

// Haramina et al. (2025), section 3.3: 0.1, 0.2, ... 3.0; 2^20 - 1 submodels of three inputs.
TEST(ExponentSearch, HasThePapersSize) {
  const auto exponents = paper_exponents();
  ASSERT_EQ(exponents.size(), 30u);
  EXPECT_EQ(exponents[0], 0.1);
  EXPECT_EQ(exponents[1], 0.2);
  EXPECT_EQ(exponents[29], 3.0);
  const ExponentSearch search =
      search_exponents(random_points(40, 1), Surrogate::distance, {0.5, 1});
  EXPECT_EQ(search.pairs.size(), 4u);
  EXPECT_EQ(search.submodels, 1048575);
  EXPECT_EQ(search.pairs[1].r, 0.5);
  EXPECT_EQ(search.pairs[1].q, 1);
  for (const PairBest& pair : search.pairs) EXPECT_GE(pair.press, search.pairs[search.best].press);
}

/// The least PRESS of all submodels, each fitted by itself.
double brute_force(const Eigen::MatrixXd& columns, const Eigen::VectorXd& w) {
  double least = INFINITY;
  for (int model = 1; model < 1 << columns.cols(); ++model) {
    std::vector<int> terms;
    for (int t = 0; t < columns.cols(); ++t) {
      if (model >> t & 1) terms.push_back(t);
    }
    least = std::min(least, fit_least_squares(columns(Eigen::all, terms), w).press);
  }
  return least;
}

// Ten terms of two inputs have 1023 submodels.
TEST(ExponentSearch, AgreesWithBruteForceAtEveryPair) {
  const WearPoints points = random_points(35, 2);
  const std::vector<double> exponents = {0.4, 1.1, 2};
  for (const bool drop_temperature : {false, true}) {
    const Surrogate surrogate = drop_temperature ? Surrogate::distance : Surrogate::energy;
    const ExponentSearch search =
        search_exponents(points, surrogate, exponents, 2, drop_temperature);
    ASSERT_EQ(search.pairs.size(), 9u);
    ASSERT_EQ(search.submodels, 1023);
    for (const PairBest& pair : search.pairs) {
      Eigen::MatrixXd values = input_values(surrogate, pair.r, pair.q, points.at);
      if (drop_temperature) values = values(Eigen::all, std::vector<int>{0, 2}).eval();
      const Eigen::MatrixXd columns = make_design(polynomial_terms({"a", "b"}, 3), values).columns;
      EXPECT_NEAR(pair.press / brute_force(columns, points.w), 1, 1e-8) << pair.r << ' ' << pair.q;
      const LinearFit fit = fit_least_squares(columns(Eigen::all, pair.terms), points.w);
      EXPECT_NEAR(pair.press / fit.press, 1, 1e-8);
      EXPECT_NEAR(pair.r2p, fit.r2p, 1e-8);
      EXPECT_NEAR(pair.r2, fit.r2, 1e-8);
    }
  }
}

// A pair that is left early must not be the best: whatever the start and the number of threads, the
// best of all pairs is found to the bit.
TEST(BestExponents, IsTheBestOfAllPairs) {
  for (std::uint64_t seed = 10; seed < 16; ++seed) {
    const WearPoints points = random_points(30 + static_cast<int>(seed), seed);
    const std::vector<double> exponents = {0.3, 0.7, 1.2, 2.4};
    for (const Surrogate surrogate : surrogates) {
      const ExponentSearch all = search_exponents(points, surrogate, exponents, 1);
      const PairBest& best = all.pairs[all.best];
      for (const std::vector<int>& start : {std::vector<int>{}, {0}, {1, 3, 5}}) {
        for (const int threads : {1, 2}) {
          const PairBest found = best_exponents(points, surrogate, exponents, start, threads);
          EXPECT_EQ(found.r, best.r) << seed;
          EXPECT_EQ(found.q, best.q) << seed;
          EXPECT_EQ(found.press, best.press) << seed;
          EXPECT_EQ(found.terms, best.terms) << seed;
        }
      }
    }
  }
}

TEST(ExponentSearch, DoesNotDependOnThreads) {
  const WearPoints points = random_points(50, 3);
  const ExponentSearch one = search_exponents(points, Surrogate::distance, {0.3, 0.9, 1.7}, 1),
                       two = search_exponents(points, Surrogate::distance, {0.3, 0.9, 1.7}, 2);
  EXPECT_EQ(one.best, two.best);
  for (std::size_t i = 0; i < one.pairs.size(); ++i) {
    EXPECT_EQ(one.pairs[i].press, two.pairs[i].press);
    EXPECT_EQ(one.pairs[i].terms, two.pairs[i].terms);
  }
}

// Without noise the exponents and terms are found as they are.
TEST(ExponentSearch, FindsTheTruthWithoutNoise) {
  WearPoints points = random_points(60, 4);
  for (int j = 0; j < 60; ++j) {
    const OperatingPoint& at = points.at[static_cast<std::size_t>(j)];
    const double ds = std::pow(at.slip_speed, 1.2) * std::pow(at.closing_time, 0.5) / 1000;
    points.w[j] = (3 + ds * at.temperature / 50 + at.torque * at.torque / 1000) * mm3_per_MJ;
  }
  const ExponentSearch search = search_exponents(points, Surrogate::distance, {0.6, 0.9, 1.2, 0.5});
  const PairBest& best = search.pairs[search.best];
  EXPECT_EQ(best.r, 1.2);
  EXPECT_EQ(best.q, 0.5);
  EXPECT_NEAR(best.r2p, 1, 1e-12);
  const WearMap map = fit_map("selected", points, Surrogate::distance, 1.2, 0.5, 3, best.terms);
  const std::vector<OperatingPoint> elsewhere = {{180, 33, 200, 2.2}};
  const double ds = std::pow(180, 1.2) * std::pow(2.2, 0.5) / 1000;
  EXPECT_NEAR(map.predict(elsewhere)[0] / mm3_per_MJ, 3 + ds * 4 + 33 * 33 / 1000.0, 1e-6);
}

// The rows of Tables 2 and 5 of the paper: linear 4 terms, full cubic 20, temperature alone 4.
TEST(WearMap, HasThePapersBaselines) {
  const WearPoints points = random_points(60, 5);
  EXPECT_EQ(fit_map("linear", points, Surrogate::distance, 1, 1, 1, {}).terms.size(), 4u);
  EXPECT_EQ(fit_map("full cubic", points, Surrogate::distance, 1, 1, 3, {}).terms.size(), 20u);
  const WearMap temperature = fit_temperature_map(points);
  EXPECT_EQ(temperature.terms.size(), 4u);
  EXPECT_LT((temperature.predict(points.at) - temperature.fit.fitted).cwiseAbs().maxCoeff(),
            1e-12 * mm3_per_MJ);
  const WearMap some = fit_map("selected", points, Surrogate::distance, 1, 1, 3, {0, 1, 5});
  EXPECT_LT((some.predict(points.at) - some.fit.fitted).cwiseAbs().maxCoeff(), 1e-9 * mm3_per_MJ);
}

// By hand: w = 1, 2, 4 less their mean are -4/3, -1/3, 5/3.
TEST(Correlation, ByHand) {
  WearPoints points;
  points.w = Eigen::Vector3d(1, 2, 4);
  points.at = {{10, 1, 4, 3}, {20, 2, 2, 5}, {10, 4, 1, 5}};
  const auto r = correlations(points);
  EXPECT_NEAR(r[0], -1 / std::sqrt(28), 1e-14);
  EXPECT_NEAR(r[1], 1, 1e-14);
  EXPECT_NEAR(r[2], -13 / 14.0, 1e-14);
}

}  // namespace
}  // namespace wearwell::clutch
