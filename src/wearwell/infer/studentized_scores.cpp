#include "wearwell/infer/studentized_scores.h"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

constexpr double known = 0.5;  // least variance of a mean that is standardized to 1
constexpr std::size_t null_samples = 1000;
constexpr std::uint64_t seed = 20261125;

// Scales all draws to the same mean square.
void even_out_size(std::vector<std::vector<double>>& scores) {
  std::vector<double> size;
  for (const auto& z : scores)
    size.push_back(std::sqrt(std::inner_product(z.begin(), z.end(), z.begin(), 0.0)));
  const double middle =
      std::accumulate(size.begin(), size.end(), 0.0) / static_cast<double>(size.size());
  for (std::size_t s = 0; s < scores.size(); ++s) {
    if (!(size[s] > 0)) continue;
    for (double& each : scores[s]) each *= middle / size[s];
  }
}

// The studentized score is `of_mean` times the mean over draws and `of_deviation` times the draw's
// deviation from it.
struct Factors {
  Eigen::VectorXd of_mean, of_deviation;
};

Factors factors(const Eigen::MatrixXd& deviation) {
  const Eigen::VectorXd variance = deviation.colwise().squaredNorm();
  Factors factors{variance, variance};
  for (Eigen::Index i = 0; i < variance.size(); ++i) {
    const double c = std::min(variance[i], 1.0), of_mean = 1 / std::sqrt(std::max(1 - c, known));
    factors.of_mean[i] = of_mean;
    factors.of_deviation[i] = c > known ? std::sqrt((1 - of_mean * of_mean * (1 - c)) / c) : 0;
  }
  return factors;
}

// The right singular vectors whose singular values exceed 1e-3, and these values, at most 1. From the
// smaller of the two products of the matrix with itself.
struct PrincipalAxes {
  Eigen::MatrixXd vectors;
  Eigen::VectorXd size;
};

PrincipalAxes principal_axes(const Eigen::MatrixXd& matrix) {
  constexpr double least = 1e-3;
  const bool tall = matrix.rows() >= matrix.cols();
  const Eigen::MatrixXd product = tall ? Eigen::MatrixXd(matrix.transpose() * matrix)
                                       : Eigen::MatrixXd(matrix * matrix.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(product);
  const auto rank = (solved.eigenvalues().array() > least * least).count();
  const Eigen::VectorXd size = solved.eigenvalues().tail(rank).cwiseSqrt();
  const Eigen::MatrixXd found = solved.eigenvectors().rightCols(rank);
  return {
      tall ? found : Eigen::MatrixXd(matrix.transpose() * found * size.cwiseInverse().asDiagonal()),
      size.cwiseMin(1.0)};
}

}  // namespace

StudentizedScores studentized_scores(std::vector<std::vector<double>> scores,
                                     const std::vector<bool>& exact) {
  even_out_size(scores);
  const auto draws = std::ssize(scores), count = std::ssize(exact);
  const double root = std::sqrt(static_cast<double>(draws));
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(count);
  Eigen::MatrixXd deviation = Eigen::MatrixXd::Zero(draws, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!exact[at]) continue;
    for (const auto& z : scores) mean[i] += z[at] / static_cast<double>(draws);
    for (Eigen::Index s = 0; s < draws; ++s)
      deviation(s, i) = (scores[static_cast<std::size_t>(s)][at] - mean[i]) / root;
  }
  const Factors by = factors(deviation);
  bool alike = true;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    alike = alike && exact[at] && by.of_deviation[i] == 0;
    if (!exact[at]) continue;
    for (auto& z : scores) z[at] = by.of_mean[i] * mean[i] + by.of_deviation[i] * (z[at] - mean[i]);
  }
  if (alike) scores.resize(1);
  return {std::move(scores), std::move(deviation)};
}

double null_size(const StudentizedScores& of,
                 const std::function<double(std::span<const double>)>& test) {
  const auto [axes, size] = principal_axes(of.deviation);
  const Eigen::Index rank = size.size();
  const Eigen::VectorXd of_mean = (1 - size.array().square()).sqrt();
  const Factors by = factors(of.deviation);
  std::vector<double> squares(null_samples);
  tbb::parallel_for(std::size_t{0}, null_samples, [&](std::size_t s) {
    Rng rng(seed, s);
    Eigen::VectorXd z(axes.rows()), between(rank);
    for (double& each : z) each = rng.normal();
    for (double& each : between) each = rng.normal();
    const Eigen::VectorXd along = axes.transpose() * z;
    const Eigen::VectorXd mean = z + axes * (of_mean.array() - 1).matrix().cwiseProduct(along);
    const Eigen::VectorXd off = axes * size.cwiseProduct(between);
    const Eigen::VectorXd sample =
        by.of_mean.cwiseProduct(mean) + by.of_deviation.cwiseProduct(off);
    squares[s] = std::pow(test({sample.data(), static_cast<std::size_t>(sample.size())}), 2);
  });
  return std::sqrt(std::accumulate(squares.begin(), squares.end(), 0.0) / null_samples);
}

}  // namespace wearwell
