#include "wearwell/predict/interpolated.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

using Eigen::Index;

constexpr Index most_axes = 4;
constexpr double tolerance = 0.03;  // relative misfit of the polynomials

// Products of Hermite polynomials of the whitened parameters, normalized under the normal
// distribution.
class Basis {
 public:
  explicit Basis(const ThinnedPosterior& few) : axes_(few.values.cols()) {
    const Eigen::Map<const Eigen::VectorXd> w(few.weights.data(),
                                              static_cast<Index>(few.weights.size()));
    mean_ = w.transpose() * few.values;
    Points away = few.values.rowwise() - mean_;
    size_ = (w.transpose() * away.cwiseAbs2()).cwiseSqrt();
    for (double& each : size_) each = each > 0 ? each : 1;
    away.array().rowwise() /= size_.array();
    const Eigen::MatrixXd covariance = away.transpose() * w.asDiagonal() * away;
    llt_.compute(covariance);
    constexpr int degrees[] = {0, 12, 9, 7, 5};
    degree_ = degrees[axes_];
    std::vector<int> powers(static_cast<std::size_t>(axes_), 0);
    add_powers(powers, 0, degree_);
  }

  bool exists() const { return llt_.info() == Eigen::Success; }
  Index size() const { return static_cast<Index>(powers_.size()) / axes_; }

  void evaluate(const double* x, double* values) const {
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_axes, 1> z(axes_);
    for (Index a = 0; a < axes_; ++a) z[a] = (x[a] - mean_[a]) / size_[a];
    llt_.matrixL().solveInPlace(z);
    double hermite[most_axes][16];
    for (Index a = 0; a < axes_; ++a) {
      // Clamps to the range of the few points; beyond it there is little weight.
      constexpr double reach = 6;
      const double at = std::clamp(z[a], -reach, reach);
      hermite[a][0] = 1;
      hermite[a][1] = at;
      for (int k = 1; k < degree_; ++k)
        hermite[a][k + 1] =
            (at * hermite[a][k] - std::sqrt(static_cast<double>(k)) * hermite[a][k - 1]) /
            std::sqrt(k + 1.0);
    }
    const int* power = powers_.data();
    for (Index i = 0; i < size(); ++i) {
      values[i] = 1;
      for (Index a = 0; a < axes_; ++a) values[i] *= hermite[a][*power++];
    }
  }

 private:
  void add_powers(std::vector<int>& powers, std::size_t axis, int left) {
    if (axis == powers.size()) {
      powers_.insert(powers_.end(), powers.begin(), powers.end());
      return;
    }
    for (powers[axis] = 0; powers[axis] <= left; ++powers[axis])
      add_powers(powers, axis + 1, left - powers[axis]);
    powers[axis] = 0;
  }

  Index axes_;
  int degree_ = 0;
  Eigen::RowVectorXd mean_, size_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  std::vector<int> powers_;
};

// Uses the logarithm for quantities of one sign, because its polynomials need fewer terms.
struct Scaled {
  Points values;
  std::vector<bool> logarithm, finite;

  explicit Scaled(const Points& at_few) : values(at_few) {
    for (Index j = 0; j < values.cols(); ++j) {
      finite.push_back(values.col(j).allFinite());
      logarithm.push_back(finite.back() && values.col(j).minCoeff() > 0);
      if (logarithm.back()) values.col(j) = values.col(j).array().log();
      if (!finite.back()) values.col(j).setZero();
    }
  }
};

// The relative root mean square misfit of each quantity's polynomial at the validation points;
// infinite if not finite.
std::vector<double> misfits(const ThinnedPosterior& few, const Points& at_few, const Scaled& scaled,
                            const Points& terms, const Eigen::MatrixXd& coefficients,
                            const std::vector<Index>& judging) {
  std::vector<double> found;
  for (Index j = 0; j < at_few.cols(); ++j) {
    double missed = 0, weights = 0, middle = 0;
    for (const Index i : judging) {
      const double weight = few.weights[static_cast<std::size_t>(i)];
      const double off = terms.row(i).dot(coefficients.col(j)) - scaled.values(i, j);
      missed += weight * off * off;
      middle += weight * std::abs(at_few(i, j));
      weights += weight;
    }
    const auto at = static_cast<std::size_t>(j);
    const double scale = scaled.logarithm[at] ? 1 : middle / weights;
    found.push_back(scaled.finite[at] ? std::sqrt(missed / weights) / scale : infinity);
  }
  return found;
}

}  // namespace

std::vector<std::optional<Interpolated>> interpolated(const WeightedDraws& draws,
                                                      const ThinnedPosterior& few,
                                                      const Points& at_few) {
  std::vector<std::optional<Interpolated>> found(static_cast<std::size_t>(at_few.cols()));
  const Index n = at_few.rows();
  if (draws.lower.empty() || draws.values.cols() > most_axes) return found;
  const Basis basis(few);
  constexpr Index apart = 8;  // every eighth point is for validation
  if (!basis.exists() || n < 2 * apart * basis.size() / (apart - 1)) return found;
  const Scaled scaled(at_few);
  Points all(n, basis.size());
  for (Index i = 0; i < n; ++i) basis.evaluate(few.values.row(i).data(), all.row(i).data());
  std::vector<Index> fitted, judging;
  for (Index i = 0; i < n; ++i) (i % apart == apart / 2 ? judging : fitted).push_back(i);
  const auto size = static_cast<Index>(fitted.size());
  Eigen::MatrixXd left(size, basis.size()), right(size, at_few.cols());
  for (Index k = 0; k < size; ++k) {
    const Index i = fitted[static_cast<std::size_t>(k)];
    const double root = std::sqrt(few.weights[static_cast<std::size_t>(i)]);
    left.row(k) = root * all.row(i);
    right.row(k) = root * scaled.values.row(i);
  }
  const Eigen::MatrixXd coefficients = left.colPivHouseholderQr().solve(right);
  const std::vector<double> missed = misfits(few, at_few, scaled, all, coefficients, judging);
  std::vector<Index> good;
  for (Index j = 0; j < at_few.cols(); ++j)
    if (missed[static_cast<std::size_t>(j)] <= tolerance) good.push_back(j);
  if (good.empty()) return found;
  const auto count = static_cast<Index>(good.size());
  Eigen::MatrixXd chosen(basis.size(), count);
  for (Index k = 0; k < count; ++k)
    chosen.col(k) = coefficients.col(good[static_cast<std::size_t>(k)]);
  const Index cells = draws.has_cells() ? draws.cells.mass.size() : draws.lower[0].rows();
  const double least = QuantityDistribution::least_weight(draws);
  const auto everywhere = [&](const Points& of) {
    Points values = Points::Zero(cells, count);
    tbb::parallel_for(tbb::blocked_range<Index>(0, cells, 256), [&](const auto& some) {
      Eigen::RowVectorXd terms(basis.size());
      for (Index i = some.begin(); i < some.end(); ++i) {
        if (!(draws.cell_weight(i) > least)) continue;
        basis.evaluate(of.row(i).data(), terms.data());
        values.row(i) = terms * chosen;
        for (Index k = 0; k < count; ++k)
          if (scaled.logarithm[static_cast<std::size_t>(good[static_cast<std::size_t>(k)])])
            values(i, k) = std::exp(values(i, k));
      }
    });
    return values;
  };
  WeightedDraws whole{everywhere(draws.values), draws.weights.head(cells), {}, {}, draws.cells};
  for (const Points& ends : draws.lower) whole.lower.push_back(everywhere(ends));
  for (const Points& ends : draws.upper) whole.upper.push_back(everywhere(ends));
  for (Index k = 0; k < count; ++k) {
    const auto j = static_cast<std::size_t>(good[static_cast<std::size_t>(k)]);
    found[j] =
        Interpolated{QuantityDistribution(whole, [k](const double* x) { return x[k]; }), missed[j]};
  }
  return found;
}

}  // namespace wearwell
