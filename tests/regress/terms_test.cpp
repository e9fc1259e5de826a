#include "wearwell/regress/terms.h"

#include <gtest/gtest.h>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/regress/least_squares.h"

namespace wearwell {
namespace {

std::vector<std::string> names(const std::vector<Term>& terms) {
  std::vector<std::string> result;
  for (const auto& term : terms) result.push_back(term.name);
  return result;
}

TEST(PolynomialTerms, AreOrderedByDegreeThenByInput) {
  const std::vector<std::string> expected = {"1", "ds", "Td", "ds*ds", "ds*Td", "Td*Td"};
  EXPECT_EQ(names(polynomial_terms({"ds", "Td"}, 2)), expected);
  const std::vector<std::string> cubic = {"1", "a", "a*a", "a*a*a"};
  EXPECT_EQ(names(polynomial_terms({"a"}, 3)), cubic);
  EXPECT_EQ(names(polynomial_terms({"a", "b"}, 0)), std::vector<std::string>{"1"});
}

// Haramina et al. (2025): 20 terms of a cubic in three inputs, 35 in four.
TEST(PolynomialTerms, CountsOfTheClutchPaper) {
  EXPECT_EQ(polynomial_terms({"ds", "Td", "Mz"}, 3).size(), 20);
  EXPECT_EQ(polynomial_terms({"n", "Td", "Mz", "t"}, 3).size(), 35);
}

TEST(PolynomialTerms, RefusesWhatCannotBeNamed) {
  EXPECT_THROW(polynomial_terms({}, 2), InputError);
  EXPECT_THROW(polynomial_terms({"a", "a"}, 2), InputError);
  EXPECT_THROW(polynomial_terms({"a", ""}, 2), InputError);
  EXPECT_THROW(polynomial_terms({"a"}, -1), InputError);
  EXPECT_THROW(polynomial_terms({"a", "b", "c", "d", "e"}, 30), InputError);
}

Eigen::MatrixXd random_inputs(int rows, int count, std::uint64_t seed) {
  Rng rng(seed, 0);
  Eigen::MatrixXd inputs(rows, count);
  for (double& x : inputs.reshaped()) x = rng.uniform(-3, 40);
  return inputs;
}

TEST(Design, ScalesEveryTermToTheUnitInterval) {
  const auto inputs = random_inputs(20, 2, 1);
  const auto design = make_design(polynomial_terms({"a", "b"}, 3), inputs);
  EXPECT_TRUE((design.columns.col(0).array() == 1).all());
  for (int t = 1; t < design.columns.cols(); ++t) {
    EXPECT_EQ(design.columns.col(t).minCoeff(), 0);
    EXPECT_EQ(design.columns.col(t).maxCoeff(), 1);
  }
  // a*a*b in the third row, by hand: degree 3 starts at 6 with a*a*a.
  ASSERT_EQ(design.terms[7].name, "a*a*b");
  const double value = inputs(2, 0) * inputs(2, 0) * inputs(2, 1);
  EXPECT_NEAR(design.columns(2, 7) * design.range[7] + design.minimum[7], value,
              1e-12 * design.range[7]);
}

TEST(Design, NamesTheOffendingTerm) {
  Eigen::MatrixXd inputs = random_inputs(5, 2, 2);
  inputs.col(1).setConstant(7);
  const auto terms = polynomial_terms({"a", "b"}, 1);
  try {
    make_design(terms, inputs);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "term 'b' is 7 in every row; only the constant may be");
  }
  inputs(3, 1) = NAN;
  try {
    make_design(terms, inputs);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "term 'b' is nan in row 4; it must be a finite number");
  }
}

// The same model fitted to unscaled columns is the independent witness.
TEST(OriginalCoefficients, AreThoseOfTheUnscaledFit) {
  const auto inputs = random_inputs(30, 2, 3);
  Rng rng(4, 0);
  Eigen::VectorXd response(30);
  for (double& y : response) y = rng.normal();
  const auto design = make_design(polynomial_terms({"a", "b"}, 2), inputs);
  const std::vector<int> chosen = {0, 2, 4};  // 1, b, a*b
  const Eigen::MatrixXd scaled = design.columns(Eigen::all, chosen);
  EXPECT_TRUE(scaled_terms(design, chosen, inputs).isApprox(scaled, 1e-14));
  const auto fit = fit_least_squares(scaled, response);
  const auto original = original_coefficients(design, chosen, fit.coefficients, fit.covariance);

  Eigen::MatrixXd plain(30, 3);
  plain << Eigen::VectorXd::Ones(30), inputs.col(1), inputs.col(0).cwiseProduct(inputs.col(1));
  const auto expected = fit_least_squares(plain, response);
  EXPECT_NEAR(original.intercept, expected.coefficients[0], 1e-12);
  EXPECT_NEAR(original.intercept_error, expected.standard_errors[0], 1e-12);
  for (int j = 1; j < 3; ++j) {
    EXPECT_NEAR(original.coefficients[j] / expected.coefficients[j], 1, 1e-10);
    EXPECT_NEAR(original.standard_errors[j] / expected.standard_errors[j], 1, 1e-10);
  }
}

TEST(OriginalCoefficients, HaveAnInterceptWithoutAConstantTerm) {
  const auto inputs = random_inputs(12, 1, 5);
  const auto design = make_design(polynomial_terms({"a"}, 1), inputs);
  const std::vector<int> chosen = {1};
  const Eigen::VectorXd b = Eigen::VectorXd::Constant(1, 2.5);
  const auto original = original_coefficients(design, chosen, b, Eigen::MatrixXd::Identity(1, 1));
  const Eigen::VectorXd predicted = design.columns.col(1) * 2.5;
  for (int i = 0; i < 12; ++i)
    EXPECT_NEAR(original.intercept + original.coefficients[0] * inputs(i, 0), predicted[i], 1e-13);
}

}  // namespace
}  // namespace wearwell
