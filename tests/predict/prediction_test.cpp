#include "wearwell/predict/prediction.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "support/between.h"

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

constexpr double z95 = 1.6448536269514722;  // R: qnorm(0.95)

const Function mean = [](const double* x) { return x[0]; };
const Function sd = [](const double* x) { return x[1]; };

WeightedDraws draws_of(const std::vector<std::pair<double, double>>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  WeightedDraws draws{
      Points(n, 2), Eigen::VectorXd::Constant(n, 1 / static_cast<double>(n)), {}, {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    draws.values(i, 0) = points[static_cast<std::size_t>(i)].first;
    draws.values(i, 1) = points[static_cast<std::size_t>(i)].second;
  }
  return draws;
}

// One cell: the first parameter evenly between lower and upper.
WeightedDraws even(double lower, double upper) {
  WeightedDraws draws{Points(1, 2), Eigen::VectorXd::Ones(1), {Points(1, 2)}, {Points(1, 2)}};
  draws.values << 0.5 * (lower + upper), 1;
  draws.lower[0] << lower, 1;
  draws.upper[0] << upper, 1;
  return draws;
}

TEST(Predict, OneDrawIsItsOwnLaw) {
  const WeightedDraws one = draws_of({{90e-9, 2e-9}});
  const Prediction p = predict(one, mean, sd, ObservationFamily::normal);
  EXPECT_DOUBLE_EQ(p.mean, 90e-9);
  EXPECT_DOUBLE_EQ(p.ci05, 90e-9);
  EXPECT_DOUBLE_EQ(p.ci95, 90e-9);
  EXPECT_NEAR(p.pi05, 90e-9 - z95 * 2e-9, 1e-6 * 90e-9);
  EXPECT_NEAR(p.pi95, 90e-9 + z95 * 2e-9, 1e-6 * 90e-9);

  const Prediction q = predict(draws_of({{90e-9, 60e-9}}), mean, sd, ObservationFamily::lognormal);
  const double zeta = std::sqrt(std::log1p(4. / 9)), eta = std::log(90e-9) - zeta * zeta / 2;
  EXPECT_NEAR(q.pi05, std::exp(eta - z95 * zeta), 1e-6 * q.pi05);
  EXPECT_NEAR(q.pi95, std::exp(eta + z95 * zeta), 1e-6 * q.pi95);
}

// Two laws so far apart that below the lower end only one of them counts, with twice 5 %: R:
// qnorm(0.1) = -1.2815515655446004.
TEST(Predict, TwoLawsFarApart) {
  const Prediction p = predict(draws_of({{100, 1}, {0, 2}}), mean, sd, ObservationFamily::normal);
  EXPECT_DOUBLE_EQ(p.mean, 50);
  EXPECT_NEAR(p.pi05, -1.2815515655446004 * 2, 1e-5);
  EXPECT_NEAR(p.pi95, 100 + 1.2815515655446004, 1e-5);
}

// Quantiles of many laws, put back into their own mixture: 5 and 95 % of it lie below. Of one peak, of
// peaks far apart, and where few of the laws say nothing of the quantile.
TEST(Predict, QuantilesOfManyLaws) {
  std::vector<std::pair<double, double>> peak, apart, odd;
  for (int i = 0; i < 4000; ++i) {
    const double u = std::fmod(0.6180339887498949 * i, 1), v = std::fmod(0.7548776662466927 * i, 1);
    peak.emplace_back(100 + 10 * u, 1 + v);
    apart.emplace_back(i % 10 == 0 ? -1e4 : 1e4 + u, 0.1);
    // Every 15th is among the few that are looked at first.
    odd.emplace_back(i % 15 == 0 ? 1.0 : 1e3 + u, 0.01 + v);
  }
  for (const auto& points : {peak, apart, odd}) {
    const Prediction p = predict(draws_of(points), mean, sd, ObservationFamily::normal);
    const auto below = [&](double y) {
      double sum = 0;
      for (const auto& [m, s] : points) sum += 0.5 * std::erfc((m - y) / (s * std::sqrt(2.0)));
      return sum / static_cast<double>(points.size());
    };
    EXPECT_NEAR(below(p.pi05), 0.05, 1e-6);
    EXPECT_NEAR(below(p.pi95), 0.95, 1e-6);
  }
  const Prediction q = predict(draws_of(peak), mean, sd, ObservationFamily::lognormal);
  const auto below = [&](double y) {
    double sum = 0;
    for (const auto& [m, s] : peak) {
      const double zeta = std::sqrt(std::log1p(s * s / (m * m)));
      const double eta = std::log(m) - 0.5 * zeta * zeta;
      sum += 0.5 * std::erfc((eta - std::log(y)) / (zeta * std::sqrt(2.0)));
    }
    return sum / static_cast<double>(peak.size());
  };
  EXPECT_NEAR(below(q.pi05), 0.05, 1e-9);
  EXPECT_NEAR(below(q.pi95), 0.95, 1e-9);
}

// A quantile of 0, where no relative accuracy can be had: half of the mass of N(1, 1) and N(-1, 1)
// ... and 5 % of N(z95, 1) lie below 0.
TEST(Predict, QuantileOfZero) {
  const Prediction p = predict(draws_of({{z95, 1}}), mean, sd, ObservationFamily::normal);
  EXPECT_NEAR(p.pi05, 0, 1e-7);
}

// A lognormal measurement of nothing (0 cycles) is nothing.
TEST(Predict, LognormalOfNothing) {
  const Prediction p = predict(draws_of({{0, 1e-9}}), mean, sd, ObservationFamily::lognormal);
  EXPECT_EQ(p.ci95, 0);
  EXPECT_NEAR(p.pi05, 0, 1e-15);
  EXPECT_NEAR(p.pi95, 0, 1e-15);
}

RC_GTEST_PROP(Predict, MeasurementsScatterMoreThanTheTruth, ()) {
  std::vector<std::pair<double, double>> points(*rc::gen::inRange<std::size_t>(1, 20));
  for (auto& [m, s] : points) m = *between(1, 1000), s = m * *between(0.01, 0.5);
  const Prediction p = predict(draws_of(points), mean, sd, ObservationFamily::normal);
  RC_ASSERT(p.ci05 <= p.ci95);
  RC_ASSERT(p.pi05 < p.pi95);
  // The mixture puts p of its mass below its quantile.
  const auto below = [&](double y) {
    double sum = 0;
    for (const auto& [m, s] : points) sum += cdf(boost::math::normal(m, s), y);
    return sum / static_cast<double>(points.size());
  };
  RC_ASSERT(std::abs(below(p.pi05) - 0.05) < 1e-5);
  RC_ASSERT(std::abs(below(p.pi95) - 0.95) < 1e-5);
}

// The truth spread evenly and a scatter that does not depend on it: the interval of a measurement
// holds that of the truth.
RC_GTEST_PROP(Predict, IntervalsNest, ()) {
  const double center = *between(10, 100), width = *between(0.01, 5), s = *between(0.1, 5);
  std::vector<std::pair<double, double>> points;
  for (int i = -50; i <= 50; ++i) points.emplace_back(center + width * i / 50, s);
  const Prediction p = predict(draws_of(points), mean, sd, ObservationFamily::normal);
  RC_ASSERT(p.pi05 < p.ci05);
  RC_ASSERT(p.ci05 < p.mean && p.mean < p.ci95);
  RC_ASSERT(p.ci95 < p.pi95);
}

TEST(PredictLife, OfEvenLives) {
  const Life life = predict_life(even(1000, 2000), mean, 0, 0.01);
  EXPECT_NEAR(life.b1, 1010, 1e-6);
  EXPECT_NEAR(life.b10, 1100, 1e-6);
  EXPECT_NEAR(life.b50, 1500, 1e-6);
  EXPECT_NEAR(life.q05, 1050, 1e-6);
  EXPECT_NEAR(life.q95, 1950, 1e-6);
  EXPECT_NEAR(life.inspect_within, 1010, 1e-6);  // from 0 cycles
}

// By hand: at 1500 half of the lives remain, even on [1500, 2000]; 1 % of them end by 1505, 20 % by
// 1600.
TEST(PredictLife, InspectionGivenSurvival) {
  EXPECT_NEAR(predict_life(even(1000, 2000), mean, 1500, 0.01).inspect_within, 5, 1e-6);
  EXPECT_NEAR(predict_life(even(1000, 2000), mean, 1500, 0.2).inspect_within, 100, 1e-6);
  EXPECT_EQ(predict_life(even(1000, 2000), mean, 3000, 0.2).inspect_within, 0);
}

// By hand: half of the lives lie behind 1500, all behind 3000.
TEST(PredictLife, PassedAlready) {
  EXPECT_NEAR(predict_life(even(1000, 2000), mean, 1500, 0.01).passed, 0.5, 1e-9);
  EXPECT_NEAR(predict_life(even(1000, 2000), mean, 3000, 0.01).passed, 1, 1e-9);
  EXPECT_EQ(predict_life(even(1000, 2000), mean, 900, 0.01).passed, 0);
}

// All lives lie behind, and the weights add up to something less than 1 in rounding.
TEST(PredictLife, AllBehind) {
  constexpr Eigen::Index n = 49;  // 49 x (1/49) < 1 in doubles
  WeightedDraws draws{Points(n, 2), Eigen::VectorXd::Constant(n, 1. / n), {}, {}};
  draws.values.setConstant(500);
  draws.lower.push_back(draws.values.array() - 10);
  draws.upper.push_back(draws.values.array() + 10);
  const Life life = predict_life(draws, mean, 1000, 0.01);
  EXPECT_EQ(life.inspect_within, 0);
  EXPECT_NEAR(life.b50, 500, 1e-9);
}

TEST(PredictLife, LivesWithoutEnd) {
  const Function never_above = [](const double* x) { return x[0] > 1800 ? infinity : x[0]; };
  std::vector<std::pair<double, double>> points;
  for (int i = 0; i <= 1000; ++i) points.emplace_back(1000 + i, 1);
  const Life life = predict_life(draws_of(points), never_above, 0, 0.01);
  EXPECT_DOUBLE_EQ(life.b10, 1100);
  EXPECT_DOUBLE_EQ(life.b50, 1500);
  EXPECT_EQ(life.q95, infinity);
  const Life never = predict_life(draws_of({{1900, 1}, {2000, 1}}), never_above, 500, 0.01);
  EXPECT_EQ(never.b1, infinity);
  EXPECT_EQ(never.inspect_within, infinity);
}

RC_GTEST_PROP(PredictLife, QuantilesAreInOrder, ()) {
  std::vector<std::pair<double, double>> points(*rc::gen::inRange<std::size_t>(1, 50));
  for (auto& [m, s] : points) m = *between(1, 1000), s = 1;
  if (*rc::gen::arbitrary<bool>()) points[0].first = infinity;
  const Life life = predict_life(draws_of(points), mean, *between(1, 1500), *between(0.001, 0.5));
  RC_ASSERT(life.b1 <= life.q05 && life.q05 <= life.b10);
  RC_ASSERT(life.b10 <= life.b50 && life.b50 <= life.q95);
  RC_ASSERT(life.inspect_within >= 0);
}

// constant/k with ln k normal about ln 2 with standard deviation 0.5, and nothing else unknown: the life
// is lognormal about ln(constant/2). Quantiles by R: 500 * exp(0.5 * qnorm(p)).
TEST(Life, OfAnItemNotYetSeen) {
  const WeightedDraws one{Points::Constant(1, 1, 2.0), Eigen::VectorXd::Ones(1), {}, {}};
  const LifeDistribution distribution = life_distribution(
      one, 1000, [](const double* x) { return x[0]; }, [](const double*) { return 0.5; });
  EXPECT_NEAR(distribution.quantile(0.1), 263.44176, 1e-3);
  EXPECT_NEAR(distribution.quantile(0.5), 500, 1e-6);
  EXPECT_NEAR(distribution.cdf(263.44176), 0.1, 1e-7);
  EXPECT_EQ(distribution.cdf(0), 0);
  const Life life = predict_life(distribution, 0, 0.01);
  EXPECT_EQ(life.passed, 0);
  EXPECT_NEAR(life.inspect_within, life.b1, 1e-9);
  EXPECT_NEAR(life.b1, 156.24639, 1e-3);
}

}  // namespace
}  // namespace wearwell
