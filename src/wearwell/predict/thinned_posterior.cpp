#include "wearwell/predict/thinned_posterior.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "wearwell/base/rng.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/predict/prediction.h"

namespace wearwell {
namespace {

using Eigen::Index;

// Nodes of a lattice are symmetric: coordinates, weights, spreads and moments are equal but for rounding
// errors, which must not choose the points, since they would be others on another processor. Points are
// moved by up to this many standard deviations before the choice, by the same numbers everywhere.
constexpr double shift = 1e-4;
constexpr double equal =
    1e-9;  // relative difference of sums that are equal but for rounding errors

// The whitened posterior.
struct Cloud {
  Points at;
  std::vector<double> weight;
};

// Coordinates of mean 0 and covariance 1 (Gram and Schmidt). A parameter that is constant, or follows from those
// before it, has 0.
void whiten(Points& at, const Eigen::Map<const Eigen::VectorXd>& weight) {
  constexpr double least = 1e-5;  // of a direction that is no rounding error
  const auto spread = [&](const Eigen::VectorXd& x) {
    return std::sqrt(weight.dot(x.cwiseAbs2()));
  };
  for (Index j = 0; j < at.cols(); ++j) {
    Eigen::VectorXd x = at.col(j);
    const double largest = x.cwiseAbs().maxCoeff();
    if (largest > 0) x /= largest;
    x.array() -= weight.dot(x);
    const double size = spread(x);
    x *= size > 1e-12 ? 1 / size : 0;
    for (int again = 0; again < 2; ++again) {
      for (Index k = 0; k < j; ++k) x -= weight.dot(at.col(k).cwiseProduct(x)) * at.col(k);
    }
    const double rest = spread(x);
    at.col(j) = x * (rest > least ? 1 / rest : 0);
  }
}

Cloud whitened(const WeightedDraws& draws, const DominantDraws& dominant) {
  const auto n = static_cast<Index>(dominant.rows.size());
  Cloud cloud{draws.values(dominant.rows, Eigen::all), dominant.weights};
  whiten(cloud.at, {cloud.weight.data(), n});
  for (Index i = 0; i < n; ++i) {
    Rng rng(0, static_cast<std::uint64_t>(dominant.rows[static_cast<std::size_t>(i)]));
    for (double& each : cloud.at.row(i)) each += rng.uniform(-shift, shift);
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
    for (double& each : size_) each = each > 0 ? each : 1;
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

  void take_away(std::vector<std::size_t>& points, std::vector<double>& weight) const {
    const Eigen::MatrixXd sums = sums_of(points);
    const Index n = sums.rows(), free = n - sums.cols();
    // Combinations with zero moments.
    Eigen::MatrixXd none =
        sums.householderQr().householderQ() * Eigen::MatrixXd::Identity(n, n).rightCols(free);
    Eigen::Map<Eigen::VectorXd> w(weight.data(), n);
    std::vector<bool> gone(static_cast<std::size_t>(n));
    for (Index c = 0; c < free; ++c) {
      Index first = -1;
      double least = 0;
      for (Index i = 0; i < n; ++i) {
        if (gone[static_cast<std::size_t>(i)] || !(std::abs(none(i, c)) > 1e-12)) continue;
        if (!(none(i, c) > 0)) continue;
        const double share = w[i] / none(i, c);
        if (first < 0 || share < least) least = share, first = i;
      }
      if (first < 0) continue;
      w -= least * none.col(c);
      for (Index other = c + 1; other < free; ++other) {
        none.col(other) -= none(first, other) / none(first, c) * none.col(c);
      }
      w[first] = 0;
      gone[static_cast<std::size_t>(first)] = true;
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (gone[i] || !(weight[i] > 0)) continue;
      points[left] = points[i];
      weight[left++] = weight[i];
    }
    points.resize(left);
    weight.resize(left);
  }

  const Cloud& cloud_;
  Eigen::RowVectorXd middle_, size_;
};

using Order = std::function<bool(std::size_t, std::size_t)>;

// The number of the first points in this order that together weigh at least `wanted`, at most all but
// one. Moves them to the front by halving the rest that is still undecided.
template <class Before>
std::size_t cut_at(const Cloud& cloud, std::span<std::size_t> points, double wanted,
                   const Before& before) {
  std::size_t low = 0, high = points.size();
  double below = 0;
  const auto place = [&](std::size_t k) { return points.begin() + static_cast<std::ptrdiff_t>(k); };
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    std::nth_element(place(low), place(middle), place(high), before);
    double more = 0;
    for (std::size_t k = low; k < middle; ++k) more += cloud.weight[points[k]];
    if (below + more < wanted) {
      low = middle;
      below += more;
    } else {
      high = middle;
    }
  }
  return std::min(low + 1, points.size() - 1);
}

// Splits at equal weight along the axis of largest spread until there are enough regions; in each
// the points are ordered along the axis of the last split.
void halve(const Cloud& cloud, std::span<std::size_t> points, std::size_t regions,
           const Order& last, std::vector<std::size_t>& kept, std::vector<double>& weights) {
  check_stop();
  const auto moments = static_cast<std::size_t>(Region::moments(cloud.at.cols()));
  if (regions <= 1 || points.size() <= 2 * moments) {
    if (last) std::sort(points.begin(), points.end(), last);
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
  while (spread[axis] < (1 - shift) * spread.maxCoeff()) ++axis;
  const std::size_t left = regions / 2;
  const double wanted =
      (1 - equal) * sum * static_cast<double>(left) / static_cast<double>(regions);
  const auto before = [&](std::size_t a, std::size_t b) {
    const double here = cloud.at(static_cast<Index>(a), axis),
                 there = cloud.at(static_cast<Index>(b), axis);
    return here < there || (here == there && a < b);
  };
  const std::size_t cut = cut_at(cloud, points, wanted, before);
  halve(cloud, points.first(cut), left, before, kept, weights);
  halve(cloud, points.subspan(cut), regions - left, before, kept, weights);
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
    halve(whitened(draws, dominant), chosen, most / moments, {}, kept, weights);
    chosen = std::move(kept);
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
