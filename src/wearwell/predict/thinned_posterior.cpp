#include "wearwell/predict/thinned_posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/tied_ranks.h"
#include "wearwell/math/view.h"
#include "wearwell/predict/prediction.h"

namespace wearwell {
namespace {

using Eigen::Index;

// Coordinates of symmetric nodes, weights and spreads are often equal but for rounding errors. These must not choose: the
// points would be others on another processor.
constexpr double equal = 1e-9;
constexpr double equal_coordinate = 1e-7;  // in standard deviations
constexpr double least_size = 1e-5;        // of a spread or direction that is no rounding error

// Gram and Schmidt's basis of the columns, in their order, without those that follow from others:
// among nodes of a lattice moments do, and would leave directions to rounding errors.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd basis(columns.rows(), std::min(columns.rows(), columns.cols()));
  Index found = 0;
  for (Index i = 0; i < columns.cols() && found < basis.cols(); ++i) {
    Eigen::VectorXd each = columns.col(i);
    const auto before = basis.leftCols(found);
    for (int again = 0; again < 2; ++again) each -= before * (before.transpose() * each);
    const double size = each.norm();
    if (size > least_size) basis.col(found++) = each / size;
  }
  return basis.leftCols(found);
}

// The whitened posterior.
struct Cloud {
  Points at;
  std::vector<double> weight;
  std::vector<std::vector<std::uint32_t>> rank;  // of each point along each axis
};

// Coordinates of mean 0 and covariance 1. A parameter that is constant, or follows from those before it, has 0.
void whiten(Points& at, const Eigen::Map<const Eigen::VectorXd>& weight) {
  for (Index j = 0; j < at.cols(); ++j) {
    Eigen::VectorXd x = at.col(j);
    const double largest = x.cwiseAbs().maxCoeff();
    if (largest > 0) x /= largest;
    x.array() -= weight.dot(x);
    const double spread = std::sqrt(weight.dot(x.cwiseAbs2()));
    x *= spread > 1e-12 ? 1 / spread : 0;
    for (int again = 0; again < 2; ++again) {
      for (Index k = 0; k < j; ++k) x -= weight.dot(at.col(k).cwiseProduct(x)) * at.col(k);
    }
    const double size = std::sqrt(weight.dot(x.cwiseAbs2()));
    at.col(j) = size > least_size ? Eigen::VectorXd(x / size) : Eigen::VectorXd::Zero(x.size());
  }
}

Cloud whitened(const WeightedDraws& draws, const DominantDraws& dominant) {
  const auto n = static_cast<Index>(dominant.rows.size());
  Cloud cloud{draws.values(dominant.rows, Eigen::all), dominant.weights, {}};
  whiten(cloud.at, {cloud.weight.data(), n});
  for (Index j = 0; j < cloud.at.cols(); ++j) {
    const Eigen::VectorXd x = cloud.at.col(j);
    cloud.rank.push_back(tied_ranks(view(x), equal_coordinate));
  }
  return cloud;
}

// Reduces the points to at most the number of moments (1, coordinates, products) and preserves
// these moments (Tchakaloff's theorem, constructive): while there are more points, it subtracts a
// null combination until a weight is zero.
class Region {
 public:
  Region(const Cloud& cloud, std::span<const std::size_t> points) : cloud_(cloud) {
    const Index d = cloud.at.cols();
    middle_ = Eigen::RowVectorXd::Zero(d);
    double sum = 0;
    for (const std::size_t i : points) {
      middle_ += cloud.weight[i] * cloud.at.row(static_cast<Index>(i));
      sum += cloud.weight[i];
    }
    middle_ /= sum;
    Eigen::RowVectorXd square = Eigen::RowVectorXd::Zero(d);
    for (const std::size_t i : points) {
      square += cloud.weight[i] * (cloud.at.row(static_cast<Index>(i)) - middle_).cwiseAbs2();
    }
    size_ = (square / sum).cwiseSqrt();
    for (double& each : size_) each = each > least_size ? each : 1;
  }

  static Index moments(Index d) { return 1 + d + d * (d + 1) / 2; }

  // The remaining `points`, with weights that represent all.
  void reduce(std::span<const std::size_t> points, std::vector<std::size_t>& kept,
              std::vector<double>& weights) const {
    const auto most = static_cast<std::size_t>(moments(cloud_.at.cols()));
    std::vector<std::size_t> some;
    std::vector<double> weight;
    for (std::size_t next = 0; next < points.size();) {
      while (next < points.size() && some.size() < 2 * most) {
        some.push_back(points[next]);
        weight.push_back(cloud_.weight[points[next++]]);
      }
      if (some.size() > most) take_away(some, weight);
    }
    kept.insert(kept.end(), some.begin(), some.end());
    weights.insert(weights.end(), weight.begin(), weight.end());
  }

 private:
  Eigen::MatrixXd sums_of(const std::vector<std::size_t>& points) const {
    const Index d = cloud_.at.cols(), n = static_cast<Index>(points.size());
    Eigen::MatrixXd sums(n, moments(d));
    for (Index i = 0; i < n; ++i) {
      const auto row = static_cast<Index>(points[static_cast<std::size_t>(i)]);
      const Eigen::RowVectorXd x = (cloud_.at.row(row) - middle_).cwiseQuotient(size_);
      Index column = 0;
      sums(i, column++) = 1;
      for (Index a = 0; a < d; ++a) sums(i, column++) = x[a];
      for (Index a = 0; a < d; ++a) {
        for (Index b = a; b < d; ++b) sums(i, column++) = x[a] * x[b];
      }
    }
    return sums;
  }

  // Orthonormal combinations of points with zero moments.
  static Eigen::MatrixXd null_combinations(const Eigen::MatrixXd& sums) {
    const Eigen::MatrixXd independent = orthonormal(sums);
    const Eigen::MatrixXd q = independent.householderQr().householderQ();
    return q.rightCols(q.cols() - independent.cols());
  }

  // Those of them without point i.
  static Eigen::MatrixXd without(Eigen::MatrixXd combinations, Index i) {
    Eigen::VectorXd essential(combinations.cols() - 1), workspace(combinations.rows());
    double tau = 0, size = 0;
    Eigen::VectorXd(combinations.row(i)).makeHouseholder(essential, tau, size);
    combinations.applyHouseholderOnTheRight(essential, tau, workspace.data());
    combinations.row(i).setZero();
    return combinations.rightCols(combinations.cols() - 1);
  }

  void take_away(std::vector<std::size_t>& points, std::vector<double>& weight) const {
    Eigen::MatrixXd none = null_combinations(sums_of(points));
    const Index n = none.rows();
    Eigen::Map<Eigen::VectorXd> w(weight.data(), n);
    const Eigen::VectorXd whole = w;
    while (none.cols() > 0) {
      // The projection of a point does not depend on the basis.
      Index start = 0;
      while (start < n && !(none.row(start).norm() > least_size)) ++start;
      if (start == n) break;
      const Eigen::VectorXd step = none * none.row(start).transpose();
      const double least_step = equal * step.maxCoeff();
      Index first = -1;
      double least_share = 0;
      for (Index i = 0; i < n; ++i) {
        if (!(step[i] > least_step)) continue;
        const double share = w[i] / step[i];
        if (first < 0 || share < (1 - equal) * least_share) least_share = share, first = i;
      }
      w -= least_share * step;
      w = (w.array() > equal * whole.array()).select(w, 0);
      w[first] = 0;
      none = without(std::move(none), first);
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!(weight[i] > 0)) continue;
      points[left] = points[i];
      weight[left++] = weight[i];
    }
    points.resize(left);
    weight.resize(left);
  }

  const Cloud& cloud_;
  Eigen::RowVectorXd middle_, size_;
};

// Splits at equal weight along the axis of largest spread until there are enough regions.
void halve(const Cloud& cloud, std::span<std::size_t> points, std::size_t regions,
           std::vector<std::size_t>& kept, std::vector<double>& weights) {
  check_stop();
  const auto moments = static_cast<std::size_t>(Region::moments(cloud.at.cols()));
  if (regions <= 1 || points.size() <= 2 * moments) {
    return Region(cloud, points).reduce(points, kept, weights);
  }
  Eigen::RowVectorXd first = Eigen::RowVectorXd::Zero(cloud.at.cols()), second = first;
  double sum = 0;
  for (const std::size_t i : points) {
    const auto x = cloud.at.row(static_cast<Index>(i));
    first += cloud.weight[i] * x;
    second += cloud.weight[i] * x.cwiseAbs2();
    sum += cloud.weight[i];
  }
  const Eigen::RowVectorXd spread = second / sum - (first / sum).cwiseAbs2();
  Index axis = 0;
  while (spread[axis] < (1 - equal) * spread.maxCoeff()) ++axis;
  const std::vector<std::uint32_t>& rank = cloud.rank[static_cast<std::size_t>(axis)];
  std::sort(points.begin(), points.end(), [&](std::size_t a, std::size_t b) {
    return rank[a] != rank[b] ? rank[a] < rank[b] : a < b;
  });
  const std::size_t left = regions / 2;
  const double wanted =
      (1 - equal) * sum * static_cast<double>(left) / static_cast<double>(regions);
  std::size_t cut = 0;
  for (double below = 0; cut + 1 < points.size() && below < wanted; ++cut) {
    below += cloud.weight[points[cut]];
  }
  halve(cloud, points.first(cut), left, kept, weights);
  halve(cloud, points.subspan(cut), regions - left, kept, weights);
}

}  // namespace

ThinnedPosterior::ThinnedPosterior(const WeightedDraws& draws, std::size_t most) {
  const DominantDraws dominant(draws);
  const std::size_t n = dominant.rows.size();
  std::vector<std::size_t> chosen(n);
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  const auto moments = static_cast<std::size_t>(Region::moments(draws.values.cols()));
  weights = dominant.weights;
  if (n > most && 8 * moments <= most) {
    std::vector<std::size_t> kept;
    weights.clear();
    halve(whitened(draws, dominant), chosen, most / moments, kept, weights);
    chosen = std::move(kept);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& each : weights) each /= sum;
  } else if (n > most) {
    // Equal-weight points by systematic sampling along the order of the nodes, in which neighbours
    // are similar.
    std::sort(chosen.begin(), chosen.end(),
              [&](std::size_t a, std::size_t b) { return dominant.rows[a] < dominant.rows[b]; });
    std::vector<std::size_t> few;
    double sum = 0;
    const double share = 1 / static_cast<double>(most);
    for (const std::size_t each : chosen) {
      sum += dominant.weights[each];
      while (few.size() < most &&
             sum > (1 - equal) * (static_cast<double>(few.size()) + 0.5) * share) {
        few.push_back(each);
      }
    }
    chosen = few;
    weights.assign(few.size(), 1 / static_cast<double>(few.size()));
  }
  values.resize(static_cast<Index>(chosen.size()), draws.values.cols());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    values.row(static_cast<Index>(i)) = draws.values.row(dominant.rows[chosen[i]]);
  }
}

}  // namespace wearwell
