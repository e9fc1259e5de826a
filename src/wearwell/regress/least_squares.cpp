#include "wearwell/regress/least_squares.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"

namespace wearwell {
namespace {

using Index = Eigen::Index;

std::string name_of(Index column, const std::vector<std::string>& names) {
  return names.empty() ? fmt::format("column {}", column + 1) : fmt::format("'{}'", names[column]);
}

Eigen::VectorXd root_weights(const Eigen::VectorXd& weights, Index rows) {
  if (weights.size() == 0) return Eigen::VectorXd::Ones(rows);
  if (weights.size() != rows)
    throw InputError(fmt::format("{} weights for {} rows", weights.size(), rows));
  for (Index i = 0; i < rows; ++i) {
    if (!(weights[i] > 0) || !std::isfinite(weights[i]))
      throw InputError(
          fmt::format("the weight in row {} is {}; it must be positive", i + 1, weights[i]));
  }
  return weights.cwiseSqrt();
}

[[noreturn]] void refuse_dependence(const Eigen::MatrixXd& columns,
                                    const std::vector<std::string>& names, double tolerance) {
  const auto dependences = find_dependences(columns, tolerance);
  if (dependences.empty()) throw InputError("the columns are linearly dependent");
  const auto& [column, on] = dependences.front();
  std::vector<std::string> others;
  for (const int other : on) others.push_back(name_of(other, names));
  if (others.empty())
    throw InputError(fmt::format("{} is zero in every row", name_of(column, names)));
  throw InputError(fmt::format("{} is a combination of {}; remove one of them",
                               name_of(column, names), fmt::join(others, ", ")));
}

/// -2 log likelihood of the weighted normal model at its maximum.
double deviance(double rss, const Eigen::VectorXd& root_weight) {
  const auto n = static_cast<double>(root_weight.size());
  return n * (std::log(2 * std::numbers::pi * rss / n) + 1) - 2 * root_weight.array().log().sum();
}

}  // namespace

LinearFit fit_least_squares(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                            const Eigen::VectorXd& weights, const std::vector<std::string>& names,
                            double tolerance) {
  check_stop();  // a search that is stopped fits what it has, model by model
  const Index n = columns.rows(), k = columns.cols();
  if (response.size() != n)
    throw InputError(fmt::format("{} responses for {} rows", response.size(), n));
  if (n <= k) throw InputError(fmt::format("{} rows cannot determine {} terms and sigma", n, k));
  const Eigen::VectorXd root = root_weights(weights, n);
  const Eigen::MatrixXd scaled = root.asDiagonal() * columns;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(scaled);
  const auto pivots = qr.matrixQR().diagonal().cwiseAbs().array();
  const Eigen::ArrayXd least = tolerance * scaled.colwise().norm().transpose().array();
  if (!(pivots > least).all()) refuse_dependence(scaled, names, tolerance);

  LinearFit fit;
  fit.coefficients = qr.solve(root.cwiseProduct(response));
  fit.fitted = columns * fit.coefficients;
  fit.residuals = response - fit.fitted;
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(n, k);
  fit.leverages = q.rowwise().squaredNorm();
  fit.loo_residuals = fit.residuals.array() / (1 - fit.leverages.array());
  if ((1 - fit.leverages.array() < leverage_tolerance).any())
    fit.loo_residuals = (1 - fit.leverages.array() < leverage_tolerance)
                            .select(std::numeric_limits<double>::infinity(), fit.loo_residuals);

  const Eigen::ArrayXd w = root.array().square();
  const double sum = w.sum(), mean = (w * response.array()).sum() / sum;
  const auto rows = static_cast<double>(n), terms = static_cast<double>(k);
  fit.rss = (w * fit.residuals.array().square()).sum();
  fit.press = (w * fit.loo_residuals.array().square()).sum();
  fit.tss = (w * (response.array() - mean).square()).sum();
  fit.sigma = std::sqrt(fit.rss / (rows - terms));
  fit.r2 = 1 - fit.rss / fit.tss;
  fit.r2p = 1 - fit.press / fit.tss;
  fit.adjusted_r2 = 1 - fit.rss / (rows - terms) / (fit.tss / (rows - 1));
  fit.rmse = std::sqrt(fit.rss / sum);
  fit.rmsep = std::sqrt(fit.press / sum);
  fit.aic = deviance(fit.rss, root) + 2 * (terms + 1);
  const double spare = rows - terms - 2;
  fit.aicc = spare > 0 ? fit.aic + 2 * (terms + 1) * (terms + 2) / spare
                       : std::numeric_limits<double>::infinity();
  fit.bic = deviance(fit.rss, root) + std::log(rows) * (terms + 1);

  const Eigen::MatrixXd inverse = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>().solve(
      Eigen::MatrixXd::Identity(k, k));
  fit.covariance = fit.sigma * fit.sigma * (inverse * inverse.transpose());
  fit.standard_errors = fit.covariance.diagonal().cwiseSqrt();
  return fit;
}

double mallows_cp(double rss, int terms, int rows, double s2) {
  return rss / s2 - rows + 2 * terms;
}

std::vector<Dependence> find_dependences(const Eigen::MatrixXd& columns, double tolerance) {
  const Index n = columns.rows(), k = columns.cols();
  Eigen::MatrixXd q(n, std::min(n, k));
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(q.cols(), q.cols());
  std::vector<int> independent;
  std::vector<Dependence> dependences;
  for (Index j = 0; j < k; ++j) {
    const auto rank = static_cast<Index>(independent.size());
    const double length = columns.col(j).norm();
    Eigen::VectorXd rest = columns.col(j);
    Eigen::VectorXd along = Eigen::VectorXd::Zero(rank);
    for (int pass = 0; pass < 2; ++pass) {  // the second pass makes q orthogonal to rounding
      const Eigen::VectorXd more = q.leftCols(rank).transpose() * rest;
      rest -= q.leftCols(rank) * more;
      along += more;
    }
    if (rank < q.cols() && rest.norm() > tolerance * length) {
      q.col(rank) = rest.normalized();
      r.col(rank).head(rank) = along;
      r(rank, rank) = rest.norm();
      independent.push_back(static_cast<int>(j));
      continue;
    }
    const Eigen::VectorXd needs =
        r.topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solve(along);
    Dependence dependence{static_cast<int>(j), {}};
    for (Index i = 0; i < rank; ++i) {
      // A smaller share is rounding: coefficients of near-collinear columns are no more precise.
      if (std::abs(needs[i]) * columns.col(independent[i]).norm() > 1e-6 * length)
        dependence.on.push_back(independent[i]);
    }
    dependences.push_back(dependence);
  }
  return dependences;
}

}  // namespace wearwell
