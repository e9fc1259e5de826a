#pragma once

#include <Eigen/Dense>
#include <span>

namespace wearwell::plan {

/// Tests whose mean is linear in normal coefficients: y = row . coefficients + error.
struct LinearTest {
  Eigen::VectorXd row;
  double error_variance = 0;  ///< of one test, > 0
  int tests = 1;              ///< so many, with independent errors
};

/// What is known after tests, of a goal that is linear in the coefficients.
struct LinearGain {
  double variance = 0;     ///< of the goal; the same for every outcome
  double information = 0;  ///< mutual information of outcomes and coefficients, nats
};

/// In closed form: the conjugate update of normal coefficients, test by test (Chaloner and
/// Verdinelli, Bayesian experimental design: a review, Statistical Science 10, 1995, 273-304,
/// section 2). The information is half the logarithm of the ratio of the coefficients' determinants
/// before and after.
LinearGain linear_gain(Eigen::MatrixXd covariance, const Eigen::VectorXd& goal,
                       std::span<const LinearTest> tests);

}  // namespace wearwell::plan
