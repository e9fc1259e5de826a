#include "wearwell/regress/k_fold.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/regress/least_squares.h"

namespace wearwell {
namespace {

struct Data {
  Eigen::MatrixXd columns;
  Eigen::VectorXd response, weights;
};

Data random_data(int rows, int terms, std::uint64_t seed) {
  Rng rng(seed, 0);
  Data data{Eigen::MatrixXd(rows, terms), Eigen::VectorXd(rows), Eigen::VectorXd(rows)};
  for (double& x : data.columns.reshaped()) x = rng.uniform();
  for (double& y : data.response) y = rng.normal();
  for (double& w : data.weights) w = rng.uniform(0.2, 4);
  return data;
}

TEST(KFold, WithAFoldForEachRowIsPress) {
  const auto data = random_data(23, 4, 1);
  const auto fit = fit_least_squares(data.columns, data.response, data.weights);
  for (const std::uint64_t seed : {1, 2}) {
    EXPECT_NEAR(k_fold_press(data.columns, data.response, data.weights, 23, 2, seed), fit.press,
                1e-10 * fit.press);
  }
}

// Two folds of four rows: of the three ways to halve them, refitted literally, one is the answer,
// and many repeats come near the mean of all three.
TEST(KFold, AgreesWithRefittingTheOtherFold) {
  const auto data = random_data(4, 1, 2);
  const auto half = [&](int a, int b) {
    double rss = 0, cross = 0, length = 0;
    for (int i = 0; i < 4; ++i) {
      if (i == a || i == b) continue;
      cross += data.weights[i] * data.columns(i, 0) * data.response[i];
      length += data.weights[i] * data.columns(i, 0) * data.columns(i, 0);
    }
    for (const int i : {a, b})
      rss += data.weights[i] * std::pow(data.response[i] - cross / length * data.columns(i, 0), 2);
    return rss;
  };
  const double ways[] = {half(0, 1) + half(2, 3), half(0, 2) + half(1, 3), half(0, 3) + half(1, 2)};
  int seen[3] = {};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const double press = k_fold_press(data.columns, data.response, data.weights, 2, 1, seed);
    int matches = 0;
    for (int way = 0; way < 3; ++way) {
      const bool same = std::abs(press - ways[way]) < 1e-10 * ways[way];
      matches += same;
      seen[way] += same;
    }
    EXPECT_EQ(matches, 1) << press;
  }
  for (const int count : seen) EXPECT_GT(count, 5);
}

TEST(KFold, IsInfiniteWhereAFoldAloneDeterminesACoefficient) {
  auto data = random_data(12, 2, 3);
  data.columns.col(1).setZero();
  data.columns(5, 1) = 1;
  EXPECT_EQ(k_fold_press(data.columns, data.response, {}, 3, 1, 1), INFINITY);
}

TEST(KFold, RefusesImpossibleFolds) {
  const auto data = random_data(12, 2, 4);
  for (const int folds : {-1, 0, 1, 13})
    EXPECT_THROW(k_fold_press(data.columns, data.response, {}, folds, 1, 1), InputError);
  EXPECT_THROW(k_fold_press(data.columns, data.response, {}, 3, 0, 1), InputError);
}

}  // namespace
}  // namespace wearwell
