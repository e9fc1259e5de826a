#include "wearwell/infer/whitened.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <limits>

namespace wearwell {
namespace {

using Scratch = std::array<double, max_dimension>;
using ConstMap = Eigen::Map<const Eigen::VectorXd>;
using Map = Eigen::Map<Eigen::VectorXd>;

}  // namespace

Whitening whitening_at(const Mode& mode) {
  const Eigen::Index n = mode.position.size();
  if (!mode.found) return {mode.position, Eigen::MatrixXd::Identity(n, n)};
  // Scales widths of very different magnitude first, because rounding of the narrow ones would
  // dominate the wide ones.
  constexpr double far_apart = 1e10;
  const Eigen::VectorXd diagonal = mode.curvature.diagonal();
  if (diagonal.minCoeff() > 0 && diagonal.maxCoeff() > far_apart * diagonal.minCoeff()) {
    const Eigen::VectorXd width = diagonal.cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = width.asDiagonal() * mode.curvature * width.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
    const Eigen::VectorXd size = eigen.eigenvalues().cwiseMax(1e-12).cwiseSqrt().cwiseInverse();
    return {mode.position, width.asDiagonal() * eigen.eigenvectors() * size.asDiagonal()};
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(mode.curvature);
  const Eigen::VectorXd size = eigen.eigenvalues().unaryExpr(
      [](double curvature) { return curvature > 0.01 ? 1 / std::sqrt(curvature) : 1.0; });
  return {mode.position, eigen.eigenvectors() * size.asDiagonal()};
}

double WhitenedDensity::value(std::span<const double> u) const {
  return value_above(u, -std::numeric_limits<double>::infinity());
}

double WhitenedDensity::value_above(std::span<const double> u, double least) const {
  Scratch x;
  const auto n = static_cast<Eigen::Index>(u.size());
  Map(x.data(), n) = whitening_.center;
  Map(x.data(), n).noalias() += whitening_.scale.lazyProduct(ConstMap(u.data(), n));
  return density_.value_above(std::span(x.data(), u.size()), least);
}

double WhitenedDensity::value_and_gradient(std::span<const double> u,
                                           std::span<double> gradient) const {
  Scratch x, slope;
  const auto n = static_cast<Eigen::Index>(u.size());
  Map(x.data(), n) = whitening_.center;
  Map(x.data(), n).noalias() += whitening_.scale.lazyProduct(ConstMap(u.data(), n));
  const double value =
      density_.value_and_gradient(std::span(x.data(), u.size()), std::span(slope.data(), u.size()));
  Map(gradient.data(), n).noalias() =
      whitening_.scale.transpose().lazyProduct(ConstMap(slope.data(), n));
  return value;
}

}  // namespace wearwell
