#include "wearwell/infer/starts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/math/constants.h"
#include "wearwell/math/view.h"

namespace wearwell {
namespace {

// With more axes neighbours are meaningless, because all points are about equally far apart.
constexpr Eigen::Index most_for_neighbours = 8;

// Low-discrepancy points of the unit cube, one per column: fractional parts of multiples of the
// powers of the root of x^(d+1) = x + 1.
Eigen::MatrixXd evenly(Eigen::Index dimension, Eigen::Index count) {
  double root = 1.5;
  for (int i = 0; i < 64; ++i) root = std::pow(1 + root, 1 / static_cast<double>(dimension + 1));
  Eigen::MatrixXd points(dimension, count);
  double step = 1;
  for (Eigen::Index a = 0; a < dimension; ++a) {
    step /= root;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double x = 0.5 + static_cast<double>(i + 1) * step;
      points(a, i) = x - std::floor(x);
    }
  }
  // Keeps away from the faces, because extreme quantiles of long tails are bad starts.
  constexpr double margin = 1e-3;
  return margin + (1 - 2 * margin) * points.array();
}

double score_of(double share) {
  static const Distribution standard = make_distribution(Normal{0, 1}, -infinity, infinity);
  return quantile(standard, share);
}

// The start range of a parameter on the real line: from the prior, or some hundred scales about the
// start value.
double about_start(const Parameter& parameter, const Transform& transform, double score) {
  const Distribution& prior = parameter.prior;
  const bool whole_line = !std::isfinite(prior.lower) && !std::isfinite(prior.upper);
  const double z = transform.to_real(parameter.start);
  // On a whole line the unit of z is the scale itself.
  if (!whole_line) return z + 3 * score;
  return z + 2 * std::sinh(1.5 * score);
}

double of_prior(const Parameter& parameter, const Transform& transform, double share) {
  constexpr double farthest = 600;
  if (parameter.prior.proper) {
    const double x = quantile(parameter.prior, share);
    if (parameter.prior.lower < x && x < parameter.prior.upper) {
      const double z = transform.to_real(x);
      const bool whole_line =
          !std::isfinite(parameter.prior.lower) && !std::isfinite(parameter.prior.upper);
      if (whole_line || std::abs(z) < farthest) return z;
    }
  }
  return about_start(parameter, transform, score_of(share));
}

// The points that are higher than all others in a ball of the unit cube with a few points.
void add_highest(const Eigen::MatrixXd& cube, const std::vector<StartPoint>& points,
                 std::vector<StartPoint>& high) {
  const Eigen::Index d = cube.rows();
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].log_density > points[b].log_density;
  });
  const double neighbours = d == 1 ? 3 : 2.0 * static_cast<double>(d) + 2,
               half = 0.5 * static_cast<double>(d);
  const double unit_ball = std::exp(half * std::log(M_PI) - std::lgamma(half + 1));
  const double radius = std::pow(neighbours / (static_cast<double>(points.size()) * unit_ball),
                                 1 / static_cast<double>(d));
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto here = static_cast<Eigen::Index>(order[i]);
    if (!std::isfinite(points[order[i]].log_density)) break;
    bool highest = true;
    for (std::size_t j = 0; j < i && highest && d <= most_for_neighbours; ++j) {
      const auto there = static_cast<Eigen::Index>(order[j]);
      highest = (cube.col(here) - cube.col(there)).squaredNorm() > radius * radius;
    }
    if (highest) high.push_back(points[order[i]]);
  }
}

}  // namespace

StartPoints start_points(const Posterior& posterior, const Whitening& known, int count) {
  const Eigen::Index d = posterior.dimension();
  StartPoints starts;
  for (const int kind : {0, 1, 2}) {
    const Eigen::MatrixXd cube = evenly(d, kind == 0 ? count / 2 : count / 4);
    std::vector<StartPoint> points(static_cast<std::size_t>(cube.cols()));
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
      const auto column = static_cast<Eigen::Index>(i);
      Eigen::VectorXd z(d);
      for (Eigen::Index a = 0; a < d; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const double share = cube(a, column);
        z[a] = kind == 0   ? of_prior(posterior.parameters()[at], posterior.transforms()[at], share)
               : kind == 1 ? about_start(posterior.parameters()[at], posterior.transforms()[at],
                                         score_of(share))
                           : 3 * std::sinh(score_of(share));
      }
      if (kind == 2) z = known(z);
      points[i] = {z, posterior.value(view(z))};
    });
    add_highest(cube, points, starts.high);
    if (kind == 0) starts.plain = std::move(points);
  }
  std::erase_if(starts.plain,
                [](const StartPoint& point) { return !std::isfinite(point.log_density); });
  std::stable_sort(
      starts.high.begin(), starts.high.end(),
      [](const StartPoint& a, const StartPoint& b) { return a.log_density > b.log_density; });
  return starts;
}

}  // namespace wearwell
