#include "wearwell/regress/search_problem.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <bit>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/regress/least_squares.h"
#include "wearwell/regress/row_kernels.h"

namespace wearwell {
namespace {

using Index = Eigen::Index;

void check(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response,
           const Eigen::VectorXd& weights) {
  if (columns.cols() < 1 || columns.cols() > most_search_terms)
    throw InputError(
        fmt::format("{} terms; a search takes 1 to {}", columns.cols(), most_search_terms));
  if (columns.rows() < 3) throw InputError(fmt::format("{} rows; need 3", columns.rows()));
  if (response.size() != columns.rows())
    throw InputError(fmt::format("{} responses for {} rows", response.size(), columns.rows()));
  if (weights.size() != 0 && weights.size() != columns.rows())
    throw InputError(fmt::format("{} weights for {} rows", weights.size(), columns.rows()));
  for (Index i = 0; i < columns.rows(); ++i) {
    if (!columns.row(i).allFinite() || !std::isfinite(response[i]))
      throw InputError(fmt::format("row {} has a value that is not a finite number", i + 1));
    if (weights.size() != 0 && (!(weights[i] > 0) || !std::isfinite(weights[i])))
      throw InputError(
          fmt::format("the weight in row {} is {}; it must be positive", i + 1, weights[i]));
  }
  if ((response.array() == response[0]).all())
    throw InputError("the response is the same in every row");
  require_size("the response", response);
  for (Index j = 0; j < columns.cols(); ++j)
    require_size(fmt::format("term {}", j + 1), columns.col(j));
  if (weights.size() != 0) require_size("the weights", weights);
}

/// With this many rows the bounds from moments, which lack the squares of leverages, are as good as
/// those from the rows.
int many_rows(int terms) {
  return std::max(2000, 10 * terms * terms);
}

/// s2 of all terms; only cp needs it.
double full_variance(const Eigen::MatrixXd& columns, const Eigen::VectorXd& response) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(rank_tolerance);
  qr.compute(columns);
  const Index spare = columns.rows() - qr.rank();
  if (spare < 1)
    throw InputError(fmt::format("cp needs more rows ({}) than independent terms ({})",
                                 columns.rows(), qr.rank()));
  const Eigen::VectorXd rotated = qr.householderQ().transpose() * response;
  return rotated.tail(spare).squaredNorm() / static_cast<double>(spare);
}

/// PRESS from residuals with orthonormal columns `q` of the model; empty if one row alone
/// determines a coefficient.
std::optional<double> press_of(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& q,
                               Index rows) {
  const Eigen::ArrayXd complement = 1 - q.rowwise().squaredNorm().array();
  if (!(complement.head(rows) > leverage_tolerance).all()) return {};
  return (residuals.array() / complement).square().sum();
}

/// The same from residuals and columns in coordinates of the rows of `basis`.
std::optional<double> press_in_basis(const Eigen::MatrixXd& basis, const Eigen::VectorXd& residuals,
                                     const Eigen::MatrixXd& q) {
  constexpr Index block = 512;
  const Index dimension = basis.cols();
  double sum = 0;
  for (Index first = 0; first < basis.rows(); first += block) {
    const auto rows = basis.middleRows(first, std::min(block, basis.rows() - first));
    const auto press =
        press_of(rows * residuals.head(dimension), rows * q.topRows(dimension), rows.rows());
    if (!press) return {};
    sum += *press;
  }
  return sum;
}

}  // namespace

void require_size(const std::string& name, const Eigen::VectorXd& values) {
  constexpr double least = 1e-100, most = 1e100;
  const double size = values.cwiseAbs().maxCoeff();
  if (size == 0 || (size >= least && size <= most)) return;
  throw InputError(
      fmt::format("{}: the largest value is {:.3g}; its squares overflow or underflow. Use a unit "
                  "in which it lies between {:g} and {:g}",
                  name, size, least, most));
}

std::vector<int> terms_of(TermSet set) {
  std::vector<int> terms;
  for (; set != 0; set &= set - 1) terms.push_back(std::countr_zero(set));
  return terms;
}

SearchProblem::SearchProblem(const Eigen::MatrixXd& data, const Eigen::VectorXd& observed,
                             const Eigen::VectorXd& weights, Criterion criterion, bool all_rows)
    : score(criterion, 1, 0, 1, 1, 0) {
  check(data, observed, weights);
  terms = static_cast<int>(data.cols());
  rows = static_cast<int>(data.rows());
  leave_one_out = criterion == Criterion::loo;
  Eigen::VectorXd w = weights;
  if (w.size() == 0) w.setOnes(rows);
  tss = (w.array() * (observed.array() - w.dot(observed) / w.sum()).square()).sum();
  if (!(tss > 0) || !std::isfinite(tss))
    throw InputError("the response varies by less than its precision");

  Eigen::MatrixXd all(rows, terms + 1);
  all << w.cwiseSqrt().asDiagonal() * data, w.cwiseSqrt().cwiseProduct(observed);
  for (Index j = 0; j < terms; ++j) {
    const double length = all.col(j).norm();
    if (length > 0) all.col(j) /= length;
  }
  const double s2 =
      criterion == Criterion::cp ? full_variance(all.leftCols(terms), all.col(terms)) : 1;
  score = Score(criterion, rows, terms, tss, s2, w.array().log().sum());
  least_error = 1e-24 * all.col(terms).squaredNorm();
  const bool many = leave_one_out && !all_rows && rows >= many_rows(terms);
  if (many || (!leave_one_out && rows > terms + 1)) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(all);
    if (many) moments = RowMoments(qr.householderQ() * Eigen::MatrixXd::Identity(rows, terms + 1));
    all = qr.matrixQR().topRows(terms + 1).triangularView<Eigen::Upper>();
  }
  const Index block = row_kernels::row_block;
  const Index filled = (all.rows() + block - 1) / block * block;
  stored = static_cast<int>(filled);
  columns.setZero(filled, terms);
  columns.topRows(all.rows()) = all.leftCols(terms);
  response.setZero(filled);
  response.head(all.rows()) = all.col(terms);
}

std::optional<double> exact_error(const SearchProblem& problem, TermSet model) {
  const auto chosen = terms_of(model);
  const auto k = static_cast<Index>(chosen.size());
  if (k >= problem.rows) return {};
  const Eigen::MatrixXd columns = problem.columns(Eigen::all, chosen);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  // Columns have unit length, so the pivots are relative.
  if (!(qr.matrixQR().diagonal().array().abs() > rank_tolerance).all()) return {};
  Eigen::VectorXd rest = qr.householderQ().transpose() * problem.response;
  rest.head(k).setZero();
  if (!problem.leave_one_out) return std::max(rest.squaredNorm(), problem.least_error);
  rest.applyOnTheLeft(qr.householderQ());
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(problem.stored, k);
  std::optional<double> press;
  if (problem.moments.empty()) {
    press = press_of(rest, q, problem.rows);
  } else {
    press = press_in_basis(problem.moments.basis, rest, q);
  }
  if (press) press = std::max(*press, problem.least_error);
  return press;
}

}  // namespace wearwell
