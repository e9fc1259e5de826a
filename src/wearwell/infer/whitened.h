#pragma once

#include <Eigen/Dense>

#include "wearwell/infer/mode.h"

namespace wearwell {

/// An affine map x = center + scale * u after which a density is nearly standard normal about u =
/// 0.
struct Whitening {
  Eigen::VectorXd center;
  Eigen::MatrixXd scale;  ///< square, not triangular

  Eigen::VectorXd operator()(const Eigen::VectorXd& u) const { return center + scale * u; }
};

/// From the curvature at the mode; unit scale along directions that are flat or not positive.
Whitening whitening_at(const Mode& mode);

/// The density of u, up to the constant |det scale|. Refers to `density`, which must outlive it.
class WhitenedDensity final : public LogDensity {
 public:
  WhitenedDensity(const LogDensity& density, const Whitening& whitening)
      : density_(density), whitening_(whitening) {}

  int dimension() const override { return density_.dimension(); }
  double value(std::span<const double> u) const override;
  double value_above(std::span<const double> u, double least) const override;
  double value_and_gradient(std::span<const double> u, std::span<double> gradient) const override;

 private:
  const LogDensity& density_;
  const Whitening& whitening_;
};

}  // namespace wearwell
