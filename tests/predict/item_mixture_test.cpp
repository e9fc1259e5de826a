#include "wearwell/predict/item_mixture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wearwell {
namespace {

constexpr double z05 = -1.6448536269514722, z95 = -z05;  // R: qnorm(0.05)

// Draws of (ln center, log_sd) whose ln center is itself normal: the mid-quantiles of its law.
WeightedDraws normal_centers(double mean, double sd, double log_sd, std::size_t n) {
  std::vector<double> z;
  stratified_normals(0, n, z);
  WeightedDraws draws;
  draws.values.resize(static_cast<Eigen::Index>(n), 2);
  draws.weights = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(n), 1.0 / double(n));
  for (std::size_t i = 0; i < n; ++i) {
    draws.values(static_cast<Eigen::Index>(i), 0) = mean + sd * z[i];
    draws.values(static_cast<Eigen::Index>(i), 1) = log_sd;
  }
  return draws;
}

double center(const double* x) {
  return std::exp(x[0]);
}
double log_sd(const double* x) {
  return x[1];
}

// A center that is never reached is an end that never comes; one that is no number says nothing.
TEST(ItemMixture, OfCentersWithoutEnd) {
  WeightedDraws draws;
  draws.values = Eigen::MatrixXd{{0, 0.1}, {2000, 0.1}};
  draws.weights = Eigen::VectorXd::Constant(2, 0.5);
  const ItemMixture items(
      draws, [](const double* x) { return std::exp(x[0]); }, log_sd);
  EXPECT_NEAR(items.quantile(0.25), 1, 1e-6);
  EXPECT_EQ(items.quantile(0.75), INFINITY);
  const ItemMixture none(
      draws, [](const double* x) { return x[0] > 1 ? std::nan("") : 1; }, log_sd);
  EXPECT_TRUE(std::isnan(none.quantile(0.25)));
}

TEST(ItemMixture, OfOneDrawIsLognormal) {
  WeightedDraws draws;
  draws.values = Eigen::MatrixXd{{std::log(3e-15), 0.4}};
  draws.weights = Eigen::VectorXd::Ones(1);
  const ItemMixture items(draws, center, log_sd);
  EXPECT_NEAR(items.quantile(0.5) / 3e-15, 1, 1e-8);
  EXPECT_NEAR(items.quantile(0.05) / (3e-15 * std::exp(0.4 * z05)), 1, 1e-8);
  EXPECT_NEAR(items.quantile(0.95) / (3e-15 * std::exp(0.4 * z95)), 1, 1e-8);
}

// Variances of the posterior and of the items add.
TEST(ItemMixture, AddsTheVarianceOfThePosterior) {
  const ItemMixture items(normal_centers(-30, 0.3, 0.4, 20000), center, log_sd);
  EXPECT_NEAR(std::log(items.quantile(0.05)), -30 + 0.5 * z05, 1e-3);
  EXPECT_NEAR(std::log(items.quantile(0.95)), -30 + 0.5 * z95, 1e-3);
}

// A measurement of a new item: posterior, items and measurement are normal, so that its variance is
// the sum of three, 0.3^2 + 0.4^2 + 1.2^2 = 1.3^2.
TEST(Prediction, OfANewItemHasTheVarianceOfAllThree) {
  const WeightedDraws draws = normal_centers(5, 0.3, 0.4, 4000);
  const Prediction p = predict(
      draws, [](const double* x) { return x[0]; }, [](const double*) { return 1.2; },
      ObservationFamily::normal, [](const double* x, double z) { return x[0] + x[1] * z; });
  EXPECT_NEAR(p.ci05, 5 + 0.3 * z05, 2e-3);
  EXPECT_NEAR(p.ci95, 5 + 0.3 * z95, 2e-3);
  EXPECT_NEAR(p.pi05, 5 + 1.3 * z05, 5e-3);
  EXPECT_NEAR(p.pi95, 5 + 1.3 * z95, 5e-3);
}

TEST(StratifiedNormals, FillTheLawOverManyDraws) {
  std::vector<double> z, all;
  for (std::size_t draw = 0; draw < 1000; ++draw) {
    stratified_normals(draw, 7, z);
    all.insert(all.end(), z.begin(), z.end());
  }
  double sum = 0, squares = 0;
  int below = 0;
  for (const double each : all) {
    sum += each;
    squares += each * each;
    below += each < z05;
  }
  EXPECT_NEAR(sum / 7000, 0, 1e-3);
  EXPECT_NEAR(squares / 7000, 1, 2e-3);
  EXPECT_NEAR(below / 7000., 0.05, 5e-4);
}

}  // namespace
}  // namespace wearwell
