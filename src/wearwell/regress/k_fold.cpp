#include "wearwell/regress/k_fold.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <limits>
#include <numeric>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/regress/least_squares.h"

namespace wearwell {
namespace {

using Index = Eigen::Index;

/// 0 .. rows - 1 in random order (Fisher and Yates).
std::vector<Index> shuffled(Index rows, Rng& rng) {
  std::vector<Index> order(static_cast<std::size_t>(rows));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size() - 1; i > 0; --i)
    std::swap(order[i],
              order[static_cast<std::size_t>(rng.uniform() * static_cast<double>(i + 1))]);
  return order;
}

}  // namespace

std::vector<std::vector<Index>> random_folds(Index rows, int folds, std::uint64_t seed,
                                             std::uint64_t number) {
  Rng rng(seed, number);
  const auto order = shuffled(rows, rng);
  std::vector<std::vector<Index>> parts;
  for (int fold = 0; fold < folds; ++fold)
    parts.emplace_back(order.begin() + fold * rows / folds,
                       order.begin() + (fold + 1) * rows / folds);
  return parts;
}

double k_fold_press(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
                    const Eigen::VectorXd& weights, int folds, int repeats, std::uint64_t seed) {
  const Index n = columns.rows(), k = columns.cols();
  if (folds < 2 || folds > n)
    throw InputError(fmt::format("{} folds; must be 2 to {}, the number of rows", folds, n));
  if (repeats < 1) throw InputError(fmt::format("{} repeats of the folds; need 1", repeats));
  // The search decides whether a nearly dependent model counts.
  const LinearFit fit = fit_least_squares(columns, response, weights, {}, 0.5 * rank_tolerance);
  Eigen::VectorXd root = Eigen::VectorXd::Ones(n);
  if (weights.size() != 0) root = weights.cwiseSqrt();
  const Eigen::MatrixXd scaled = root.asDiagonal() * columns;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(scaled);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(n, k);
  const Eigen::VectorXd residuals = root.cwiseProduct(fit.residuals);

  double sum = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (const auto& out : random_folds(n, folds, seed, static_cast<std::uint64_t>(repeat))) {
      // Without the rows B in the fit their residuals are (I - Q_B Q_B')^-1 e_B (as in
      // leave-one-out for one row).
      const Eigen::MatrixXd part = q(out, Eigen::all);
      const auto size = static_cast<Index>(out.size());
      const Eigen::LDLT<Eigen::MatrixXd> rest(Eigen::MatrixXd::Identity(size, size) -
                                              part * part.transpose());
      if (!(rest.vectorD().minCoeff() > leverage_tolerance))
        return std::numeric_limits<double>::infinity();
      sum += rest.solve(residuals(out)).squaredNorm();
    }
  }
  return sum / repeats;
}

}  // namespace wearwell
