#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace wearwell {

/// A column counts as dependent on earlier ones if orthogonalization shortens it below this
/// fraction of its length: the rule and the value of R's lm.
inline constexpr double rank_tolerance = 1e-7;

/// A row whose leverage is within this of 1 alone determines a coefficient: without it the model
/// cannot be fitted, and its leave-one-out residual is infinite.
inline constexpr double leverage_tolerance = 1e-8;

/// Weighted least squares: y_i = x_i'b + error_i, var(error_i) = sigma^2 / w_i. With n rows, k
/// columns, residuals e_i, leverages h_i (diagonal of W^1/2 X (X'WX)^-1 X' W^1/2):
struct LinearFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;       ///< sigma^2 (X'WX)^-1
  Eigen::VectorXd standard_errors;  ///< of the coefficients
  Eigen::VectorXd fitted;
  Eigen::VectorXd residuals;      ///< y - fitted, not weighted
  Eigen::VectorXd leverages;      ///< in [0, 1], sum k
  Eigen::VectorXd loo_residuals;  ///< y_i minus its prediction without row i: e_i / (1 - h_i)
  double rss = 0;                 ///< sum of w_i e_i^2
  double press = 0;               ///< sum of w_i (leave-one-out residual)^2; infinite if h_i = 1
  double tss = 0;                 ///< sum of w_i (y_i - weighted mean)^2, with or without constant
  double sigma = 0;               ///< sqrt(rss / (n - k))
  double r2 = 0;                  ///< 1 - rss / tss
  double r2p = 0;                 ///< 1 - press / tss
  double adjusted_r2 = 0;         ///< 1 - (rss / (n - k)) / (tss / (n - 1))
  double rmse = 0;   ///< sqrt(rss / sum of w); n without weights, as in Haramina et al.
  double rmsep = 0;  ///< sqrt(press / sum of w)
  double aic = 0;    ///< -2 log likelihood + 2 (k + 1), sigma counted as in R's AIC()
  double aicc = 0;   ///< aic + 2 (k + 1)(k + 2) / (n - k - 2); infinite if n <= k + 2
  double bic = 0;    ///< -2 log likelihood + log(n) (k + 1)
};

/// Fits by Householder QR. `weights` may be empty (all 1). `names`, for messages, may be empty.
/// Throws InputError for weights that are not positive, fewer rows than columns + 1, or linearly
/// dependent columns (named, with those that they depend on).
LinearFit fit_least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                            const Eigen::VectorXd& weights = {},
                            const std::vector<std::string>& names = {},
                            double tolerance = rank_tolerance);

/// Mallows' Cp = rss / s2 - n + 2 k, where s2 = rss / (n - rank) of all candidate columns.
double mallows_cp(double rss, int terms, int rows, double s2);

/// Columns in linear dependence: `column` is a combination of the columns `on` before it.
struct Dependence {
  int column;
  std::vector<int> on;
};

/// Every column that depends on earlier ones, with the columns in its combination. A column of
/// zeros depends on none.
std::vector<Dependence> find_dependences(const Eigen::MatrixXd& columns,
                                         double tolerance = rank_tolerance);

}  // namespace wearwell
