#include "wearwell/infer/lattice_chart.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace wearwell {
namespace {

constexpr int d = 4, outer = 3;
using Z = LatticeChart::Z;

// For a parameter between two bounds the density on the real line decays no faster than exp(-|z|),
// so a lattice would extend 22 units. z = w sqrt(1 + (w/5)^2) is nearly the normal quantile of its
// uniform probability, scaled to slope 1, and makes the tail normal. Other parameters are
// unchanged.
class Bending {
 public:
  explicit Bending(const Posterior& posterior) {
    for (std::size_t i = 0; i < d; ++i) {
      const Distribution& prior = posterior.parameters()[i].prior;
      bent_[i] = std::isfinite(prior.lower) && std::isfinite(prior.upper);
    }
  }

  double from_real(std::size_t i, double z) const {
    if (!bent_[i]) return z;
    const double square = 2 * z * z / (1 + std::sqrt(1 + 4 * z * z / (far * far)));
    return std::copysign(std::sqrt(square), z);
  }
  double slope(std::size_t i, double w) const {
    return bent_[i] ? (1 + 2 * square_of(w)) / std::sqrt(1 + square_of(w)) : 1;
  }
  // Maps w to z; returns the log of the product of the slopes.
  double to_real(Z& w) const {
    double slopes = 1;
    for (std::size_t i = 0; i < d; ++i) {
      if (!bent_[i]) continue;
      const double square = square_of(w[i]), root = std::sqrt(1 + square);
      slopes *= (1 + 2 * square) / root;
      w[i] *= root;
    }
    return std::log(slopes);
  }
  LatticeChart::OnLine to_real(std::size_t i, double w) const {
    if (!bent_[i]) return {w, 0};
    const double square = square_of(w), root = std::sqrt(1 + square);
    return {w * root, std::log((1 + 2 * square) / root)};
  }

 private:
  static constexpr double far = 5;
  static double square_of(double w) { return (w / far) * (w / far); }
  std::array<bool, d> bent_{};
};

// Lines along the parameter that the others determine best, so that they follow a narrow curved
// ridge; the others by their covariance.
class Straight final : public LatticeChart {
 public:
  Straight(const Posterior& posterior, const Whitening& whitening) : bending_(posterior) {
    Eigen::Vector4d center, slopes;
    for (int i = 0; i < d; ++i) {
      const auto at = static_cast<std::size_t>(i);
      center[i] = bending_.from_real(at, whitening.center[i]);
      slopes[i] = bending_.slope(at, center[i]);
    }
    const Eigen::Matrix4d scale = slopes.cwiseInverse().asDiagonal() * whitening.scale;
    const Eigen::Matrix4d covariance = scale * scale.transpose();
    const Eigen::Matrix4d precision = covariance.inverse();
    // The smallest fraction of a parameter's variance that remains given the others.
    double least = INFINITY;
    for (int i = 0; i < d; ++i) {
      const double share = 1 / (precision(i, i) * covariance(i, i));
      if (share < least * (1 - 1e-9)) {
        least = share;
        line_ = i;
      }
    }
    for (int i = 0, at = 0; i < d; ++i) {
      if (i != line_) rest_[static_cast<std::size_t>(at++)] = i;
    }
    Eigen::Matrix3d block;
    for (int i = 0; i < outer; ++i) {
      center_[i] = center[rest_[static_cast<std::size_t>(i)]];
      for (int j = 0; j < outer; ++j)
        block(i, j) =
            covariance(rest_[static_cast<std::size_t>(i)], rest_[static_cast<std::size_t>(j)]);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(block);
    scale_ = eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().asDiagonal();
    line_center_ = center[line_];
    line_scale_ = 1 / std::sqrt(precision(line_, line_));
  }

  double to_real(const Eigen::Vector4d& u, Z& z) const override {
    const Eigen::Vector3d three = center_ + scale_ * u.head<outer>();
    for (int i = 0; i < outer; ++i)
      z[static_cast<std::size_t>(rest_[static_cast<std::size_t>(i)])] = three[i];
    z[static_cast<std::size_t>(line_)] = line_center_ + line_scale_ * u[outer];
    return bending_.to_real(z);
  }
  std::optional<std::size_t> line_parameter() const override {
    return static_cast<std::size_t>(line_);
  }
  OnLine on_line(double u) const override {
    return bending_.to_real(static_cast<std::size_t>(line_), line_center_ + line_scale_ * u);
  }
  double log_scale() const override {
    return std::log(std::abs(scale_.determinant()) * line_scale_);
  }

 private:
  Bending bending_;
  int line_ = 0;
  std::array<int, outer> rest_{};
  Eigen::Vector3d center_;
  Eigen::Matrix3d scale_;
  double line_center_ = 0, line_scale_ = 1;
};

// Along the ridge of a funnel. The lattice is sheared in the coordinates of the map; otherwise
// whole layers of cells would share one value of a parameter, whose distribution would have steps.
class AlongRidge final : public LatticeChart {
 public:
  explicit AlongRidge(const RidgeMap& map) : map_(map) {
    const Eigen::Vector4d v =
        Eigen::Vector4d(1, std::sqrt(2), std::sqrt(3), std::sqrt(5)) / std::sqrt(11);
    reflection_ = Eigen::Matrix4d::Identity() - 2 * v * v.transpose();
  }

  double to_real(const Eigen::Vector4d& u, Z& z) const override {
    RidgeMap::Coordinates turned;
    Eigen::Map<Eigen::Vector4d>(turned.data()).noalias() = reflection_ * u;
    const RidgeMap::Frame frame = map_.at(turned[static_cast<std::size_t>(map_.axis())]);
    map_.to_real(frame, turned, z);
    return frame.log_jacobian;
  }
  double log_scale() const override { return map_.log_scale(); }

 private:
  const RidgeMap& map_;
  Eigen::Matrix4d reflection_;
};

}  // namespace

std::unique_ptr<const LatticeChart> straight_chart(const Posterior& posterior,
                                                   const Whitening& whitening) {
  return std::make_unique<Straight>(posterior, whitening);
}

std::unique_ptr<const LatticeChart> ridge_chart(const RidgeMap& map) {
  return std::make_unique<AlongRidge>(map);
}

}  // namespace wearwell
