#include "wearwell/regress/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/golden.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

struct Case {
  Eigen::MatrixXd columns;
  Eigen::VectorXd response, weights;
};

Case read_case(const std::string& name, int rows, int count) {
  Case data{Eigen::MatrixXd(rows, count), Eigen::VectorXd(rows), Eigen::VectorXd(rows)};
  for (const auto& row : read_golden("regress.csv")) {
    if (row[0] != name) continue;
    const int i = std::stoi(row[1]) - 1, column = std::stoi(row[2]);
    const double value = std::stod(row[3]);
    if (column == -1) data.weights[i] = value;
    if (column == 0) data.response[i] = value;
    if (column > 0) data.columns(i, column - 1) = value;
  }
  return data;
}

/// Every statistic of `fit` under the names of regress.R.
std::map<std::string, Eigen::VectorXd> statistics_of(const LinearFit& fit) {
  const auto one = [](double value) { return Eigen::VectorXd::Constant(1, value); };
  return {{"coefficient", fit.coefficients},
          {"standard_error", fit.standard_errors},
          {"leverage", fit.leverages},
          {"loo_residual", fit.loo_residuals},
          {"rss", one(fit.rss)},
          {"press", one(fit.press)},
          {"sigma", one(fit.sigma)},
          {"r2", one(fit.r2)},
          {"r2p", one(fit.r2p)},
          {"adjusted_r2", one(fit.adjusted_r2)},
          {"aic", one(fit.aic)},
          {"aicc", one(fit.aicc)},
          {"bic", one(fit.bic)}};
}

void expect_as_in_r(const std::string& name, const LinearFit& fit, double tolerance) {
  const auto statistics = statistics_of(fit);
  int compared = 0;
  for (const auto& row : read_golden("regress_expected.csv")) {
    if (row[0] != name) continue;
    const double expected = std::stod(row[3]);
    EXPECT_NEAR(statistics.at(row[1])[std::stoi(row[2]) - 1], expected,
                tolerance * std::abs(expected))
        << row[1] << " " << row[2];
    ++compared;
  }
  EXPECT_EQ(compared, 2 * fit.coefficients.size() + 2 * fit.fitted.size() + 9);
}

TEST(LeastSquares, LongleyAsInR) {
  const auto data = read_case("longley", 16, 7);
  expect_as_in_r("longley", fit_least_squares(data.columns, data.response), 1e-8);
}

TEST(LeastSquares, WeightedAsInR) {
  const auto data = read_case("mtcars", 32, 6);
  expect_as_in_r("mtcars", fit_least_squares(data.columns, data.response, data.weights), 1e-11);
}

// NIST StRD, Longley.dat: certified values in its units (persons, thousands of dollars).
TEST(LeastSquares, LongleyAsCertifiedByNist) {
  auto data = read_case("longley", 16, 7);
  data.response *= 1000;
  data.columns.col(2) *= 1000;
  for (const int column : {3, 4}) data.columns.col(column) *= 10;
  data.columns.col(5) *= 1000;
  const auto fit = fit_least_squares(data.columns, data.response);
  const double certified[7][2] = {{-3482258.63459582, 890420.383607373},
                                  {15.0618722713733, 84.9149257747669},
                                  {-0.358191792925910E-01, 0.334910077722432E-01},
                                  {-2.02022980381683, 0.488399681651699},
                                  {-1.03322686717359, 0.214274163161675},
                                  {-0.511041056535807E-01, 0.226073200069370},
                                  {1829.15146461355, 455.478499142212}};
  for (int j = 0; j < 7; ++j) {
    EXPECT_NEAR(fit.coefficients[j] / certified[j][0], 1, 1e-9);
    EXPECT_NEAR(fit.standard_errors[j] / certified[j][1], 1, 1e-9);
  }
  EXPECT_NEAR(fit.sigma, 304.854073561965, 1e-8);
  EXPECT_NEAR(fit.r2, 0.995479004577296, 1e-13);
}

TEST(LeastSquares, RmseAndRmsepDivideByTheRows) {
  const auto data = read_case("longley", 16, 7);
  const auto fit = fit_least_squares(data.columns, data.response);
  EXPECT_DOUBLE_EQ(fit.rmse, std::sqrt(fit.residuals.squaredNorm() / 16));
  EXPECT_DOUBLE_EQ(fit.rmsep, std::sqrt(fit.loo_residuals.squaredNorm() / 16));
}

// A weight of two is the same as the row given twice, except for what counts rows.
TEST(LeastSquares, WeightTwoIsTheRowTwice) {
  const auto data = read_case("mtcars", 32, 6);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(32);
  weights[4] = 2;
  Eigen::MatrixXd columns(33, 6);
  columns << data.columns, data.columns.row(4);
  Eigen::VectorXd response(33);
  response << data.response, data.response[4];
  const auto weighted = fit_least_squares(data.columns, data.response, weights);
  const auto twice = fit_least_squares(columns, response);
  EXPECT_TRUE(weighted.coefficients.isApprox(twice.coefficients, 1e-10));
  EXPECT_NEAR(weighted.rss, twice.rss, 1e-10 * twice.rss);
  EXPECT_NEAR(weighted.leverages[4], 2 * twice.leverages[4], 1e-12);
  EXPECT_NEAR(weighted.rmse, twice.rmse, 1e-12);
}

TEST(LeastSquares, RowThatAloneDeterminesACoefficientHasNoPrediction) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(5, 2);
  columns.col(1) << 0, 0, 1, 0, 0;
  const Eigen::VectorXd response = Eigen::VectorXd::LinSpaced(5, 0, 1);
  const auto fit = fit_least_squares(columns, response);
  EXPECT_EQ(fit.loo_residuals[2], std::numeric_limits<double>::infinity());
  EXPECT_EQ(fit.press, std::numeric_limits<double>::infinity());
}

TEST(LeastSquares, NamesDependentColumns) {
  Rng rng(1, 0);
  Eigen::MatrixXd columns(10, 4);
  for (double& x : columns.reshaped()) x = rng.normal();
  columns.col(3) = columns.col(0) - 2 * columns.col(2);
  const Eigen::VectorXd response = Eigen::VectorXd::LinSpaced(10, 0, 1);
  try {
    fit_least_squares(columns, response, {}, {"1", "a", "b", "c"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "'c' is a combination of '1', 'b'; remove one of them");
  }
  EXPECT_THROW(fit_least_squares(columns.topRows(3), response.head(3)), InputError);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(10);
  weights[2] = 0;
  EXPECT_THROW(fit_least_squares(columns.leftCols(3), response, weights), InputError);
}

TEST(FindDependences, FindsEachGroupOnce) {
  Rng rng(2, 0);
  Eigen::MatrixXd columns(20, 6);
  for (double& x : columns.reshaped()) x = rng.normal();
  columns.col(2) = columns.col(0) + columns.col(1);
  columns.col(5) = 3 * columns.col(4);
  const auto found = find_dependences(columns);
  ASSERT_EQ(found.size(), 2);
  EXPECT_EQ(found[0].column, 2);
  EXPECT_EQ(found[0].on, (std::vector<int>{0, 1}));
  EXPECT_EQ(found[1].column, 5);
  EXPECT_EQ(found[1].on, (std::vector<int>{4}));
  EXPECT_TRUE(find_dependences(columns.leftCols(2)).empty());
}

}  // namespace
}  // namespace wearwell
