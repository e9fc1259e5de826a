#include "wearwell/math/gauss_of_points.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace wearwell {
namespace {

std::vector<WeightedPoint> different(std::span<const WeightedPoint> points) {
  std::vector<WeightedPoint> all;
  for (const WeightedPoint& each : points) {
    if (all.empty() || all.back().at != each.at)
      all.push_back(each);
    else
      all.back().weight += each.weight;
  }
  return all;
}

}  // namespace

std::vector<WeightedPoint> gauss_of_points(std::span<const WeightedPoint> points, int count) {
  const std::vector<WeightedPoint> all = different(points);
  if (std::ssize(all) <= count) return all;
  const double middle = 0.5 * (all.front().at + all.back().at);
  const double half = 0.5 * (all.back().at - all.front().at);
  Eigen::ArrayXd t(std::ssize(all)), weight(t.size());
  for (Eigen::Index i = 0; i < t.size(); ++i) {
    const WeightedPoint& each = all[static_cast<std::size_t>(i)];
    t[i] = (each.at - middle) / half;
    weight[i] = each.weight;
  }
  // Orthogonal polynomials at the points, by their recurrence.
  Eigen::ArrayXd before = Eigen::ArrayXd::Zero(t.size()), now = Eigen::ArrayXd::Ones(t.size());
  Eigen::MatrixXd jacobi = Eigen::MatrixXd::Zero(count, count);
  const double whole = weight.sum();
  double norm = whole, beta = 0;
  for (int k = 0; k < count; ++k) {
    const double alpha = (weight * t * now * now).sum() / norm;
    jacobi(k, k) = alpha;
    if (k + 1 == count) break;
    const Eigen::ArrayXd next = (t - alpha) * now - beta * before;
    before = now;
    now = next;
    const double next_norm = (weight * now * now).sum();
    beta = next_norm / norm;
    norm = next_norm;
    jacobi(k, k + 1) = jacobi(k + 1, k) = std::sqrt(beta);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(jacobi);
  std::vector<WeightedPoint> nodes;
  for (int k = 0; k < count; ++k) {
    const double first = solved.eigenvectors()(0, k);
    nodes.push_back({middle + half * solved.eigenvalues()[k], whole * first * first});
  }
  return nodes;
}

}  // namespace wearwell
