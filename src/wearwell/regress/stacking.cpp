#include "wearwell/regress/stacking.h"

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <vector>

#include "wearwell/base/error.h"

namespace wearwell {
namespace {

using Index = Eigen::Index;

/// min |a x - b| with x >= 0: Lawson and Hanson (1974), chapter 23.
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Index n = a.cols();
  constexpr double tolerance = 1e-12;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  std::vector<Index> active;  // the columns that may be above zero
  for (Index step = 0; step < 10 * n; ++step) {
    Eigen::VectorXd gain = a.transpose() * (b - a * x);
    for (const Index j : active) gain[j] = 0;
    Index joining = 0;
    if (!(gain.maxCoeff(&joining) > tolerance * a.col(joining).norm() * b.norm())) break;
    active.push_back(joining);
    for (bool first = true;; first = false) {
      const Eigen::MatrixXd columns = a(Eigen::all, active);
      const Eigen::VectorXd solution = columns.colPivHouseholderQr().solve(b);
      // Rounding can select a column that does not improve the fit: then the iteration ends.
      if (first && !(solution[solution.size() - 1] > 0)) return x;
      double way = 1;
      for (std::size_t i = 0; i < active.size(); ++i) {
        const double now = x[active[i]], then = solution[static_cast<Index>(i)];
        if (then <= 0) way = std::min(way, now / (now - then));
      }
      for (std::size_t i = 0; i < active.size(); ++i)
        x[active[i]] += way * (solution[static_cast<Index>(i)] - x[active[i]]);
      if (way == 1) break;
      std::erase_if(active, [&](Index j) {
        const bool out = x[j] <= tolerance;
        if (out) x[j] = 0;
        return out;
      });
      if (active.empty()) break;
    }
  }
  return x;
}

}  // namespace

Eigen::VectorXd stacking_weights(const Eigen::MatrixXd& residuals,
                                 const Eigen::VectorXd& row_weights) {
  if (residuals.cols() == 0) throw InputError("there is no model to weight");
  if (!residuals.allFinite()) throw InputError("a leave-one-out residual is not finite");
  const Index rows = residuals.rows();
  Eigen::MatrixXd a(rows + 1, residuals.cols());
  a.topRows(rows) = residuals;
  if (row_weights.size() != 0) a.topRows(rows) = row_weights.cwiseSqrt().asDiagonal() * residuals;
  // The simplex constraint as one more row: the minimizer of |E u|^2 + (sum u - 1)^2 over u >= 0 is
  // a multiple of the minimizer of |E v|^2 with sum v = 1.
  const double scale = a.topRows(rows).colwise().norm().minCoeff();
  if (!(scale > 0)) {  // an exact fit
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(residuals.cols());
    Index exact = 0;
    a.topRows(rows).colwise().norm().minCoeff(&exact);
    weights[exact] = 1;
    return weights;
  }
  a.topRows(rows) /= scale;
  a.row(rows).setOnes();
  const Eigen::VectorXd u = nonnegative_least_squares(a, Eigen::VectorXd::Unit(rows + 1, rows));
  return u / u.sum();
}

}  // namespace wearwell
