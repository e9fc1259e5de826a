#include "wearwell/regress/nested.h"

#include <gmock/gmock.h>

#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/regress/k_fold.h"
#include "wearwell/regress/selection.h"

namespace wearwell {
namespace {

using testing::HasSubstr;

struct Rows {
  Eigen::MatrixXd columns;
  Eigen::VectorXd response;
};

/// A constant and `terms` - 1 independent columns, the first three of which matter by `signal`;
/// noise of standard deviation 1.
Rows random_rows(int rows, int terms, double signal, std::uint64_t seed) {
  Rng rng(seed, 0);
  Rows data{Eigen::MatrixXd(rows, terms), Eigen::VectorXd(rows)};
  for (double& x : data.columns.reshaped()) x = rng.normal();
  data.columns.col(0).setOnes();
  for (double& y : data.response) y = 2 + rng.normal();
  for (int t = 1; t <= 3; ++t) data.response += signal * data.columns.col(t);
  return data;
}

// With as many parts as rows: each row predicted by the best of all submodels of the others, each of
// which is fitted here.
TEST(Nested, AgreesWithSearchingAnewByBruteForce) {
  const int rows = 14, terms = 5;
  const Rows data = random_rows(rows, terms, 0.7, 3);
  SearchSettings settings;
  const Nested nested = nested_search(data.columns, data.response, {}, settings, rows, 1);
  double press = 0;
  for (int out = 0; out < rows; ++out) {
    std::vector<int> kept;
    for (int row = 0; row < rows; ++row) {
      if (row != out) kept.push_back(row);
    }
    double least = INFINITY, prediction = 0;
    for (int model = 1; model < 1 << terms; ++model) {
      std::vector<int> chosen;
      for (int t = 0; t < terms; ++t) {
        if (model >> t & 1) chosen.push_back(t);
      }
      const LinearFit fit = fit_least_squares(data.columns(kept, chosen), data.response(kept));
      if (fit.press >= least) continue;
      least = fit.press;
      prediction = data.columns(out, chosen) * fit.coefficients;
    }
    press += std::pow(data.response[out] - prediction, 2);
  }
  const double total = (data.response.array() - data.response.mean()).square().sum();
  EXPECT_EQ(nested.folds, rows);
  EXPECT_EQ(nested.unproven, 0);
  EXPECT_NEAR(nested.r2, 1 - press / total, 1e-10);
  EXPECT_NEAR(nested.rmse, std::sqrt(press / rows), 1e-10);
}

// Pure noise: R2p of the winner is above 0 in every set, the nested figure is not; rows to come are
// predicted no better than by their mean.
TEST(Nested, IsNotAboveZeroOnPureNoise) {
  constexpr int sets = 40;
  double nested_mean = 0, winner_mean = 0;
  for (std::uint64_t seed = 0; seed < sets; ++seed) {
    const Rows data = random_rows(60, 12, 0, 100 + seed);
    SearchSettings settings;
    settings.keep = 1;
    settings.threads = 1;
    winner_mean +=
        search_subsets(data.columns, data.response, {}, settings).models.front().r2p / sets;
    const Nested nested = nested_search(data.columns, data.response, {}, settings, 10, seed);
    EXPECT_LT(nested.r2, 0.15) << seed;
    nested_mean += nested.r2 / sets;
  }
  EXPECT_GT(winner_mean, 0);
  EXPECT_LT(nested_mean, 0);
}

// What it says on average of many sets is what 2000 fresh rows show of the same selections.
TEST(Nested, SaysWhatFreshRowsShow) {
  constexpr int sets = 60;
  double mean = 0, square = 0;
  for (std::uint64_t seed = 0; seed < sets; ++seed) {
    const Rows data = random_rows(60, 10, 0.4, 500 + seed),
               fresh = random_rows(2000, 10, 0.4, 9000 + seed);
    SearchSettings settings;
    settings.keep = 1;
    settings.threads = 1;
    const Nested nested = nested_search(data.columns, data.response, {}, settings, 20, seed);
    const auto terms =
        search_subsets(data.columns, data.response, {}, settings).models.front().terms;
    const LinearFit fit = fit_least_squares(data.columns(Eigen::all, terms), data.response);
    const double error =
        (fresh.response - fresh.columns(Eigen::all, terms) * fit.coefficients).squaredNorm() / 2000;
    const double off = nested.rmse * nested.rmse - error;  // mean squares
    mean += off / sets;
    square += off * off / sets;
  }
  EXPECT_NEAR(mean, 0, 3 * std::sqrt(square / sets) + 0.02)
      << "0.02: a twentieth fewer rows to fit to";
}

TEST(Nested, DoesNotDependOnThreads) {
  const Rows data = random_rows(50, 12, 0.5, 8);
  SearchSettings one, two;
  one.threads = 1;
  two.threads = 2;
  const Nested a = nested_search(data.columns, data.response, {}, one, 10, 4),
               b = nested_search(data.columns, data.response, {}, two, 10, 4);
  EXPECT_EQ(a.r2, b.r2);
  EXPECT_EQ(a.r2_error, b.r2_error);
}

TEST(Nested, SaysWhyItWasNotDone) {
  const Rows data = random_rows(30, 6, 1, 9);
  const std::atomic<bool> stop = true;
  SearchSettings settings;
  settings.stop = &stop;
  EXPECT_THAT(nested_search(data.columns, data.response, {}, settings, 10, 1).problem,
              HasSubstr("stopped"));
  // Without the rows of one part a column is zero everywhere, or the response constant.
  Eigen::VectorXd one = Eigen::VectorXd::Zero(30);
  one[7] = 1;
  settings.stop = nullptr;
  EXPECT_THAT(nested_search(data.columns, one, {}, settings, 30, 1).problem,
              HasSubstr("without 1 of the 30 rows"));
}

TEST(Folds, AreAPartition) {
  const auto parts = random_folds(23, 5, 1, 0);
  std::vector<int> seen(23, 0);
  for (const auto& part : parts) {
    EXPECT_GE(part.size(), 4u);
    EXPECT_LE(part.size(), 5u);
    for (const Eigen::Index row : part) ++seen[static_cast<std::size_t>(row)];
  }
  EXPECT_EQ(seen, std::vector<int>(23, 1));
}

}  // namespace
}  // namespace wearwell
