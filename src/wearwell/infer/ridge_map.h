#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/ridge.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// Cubic splines for vectors of a few values: twice continuously differentiable, linear beyond the
/// ends.
class Splines {
 public:
  Splines() = default;
  /// `at` is ascending with at least two points; `values` has a row per point.
  Splines(std::vector<double> at, Eigen::MatrixXd values);

  Eigen::Index size() const { return values_.cols(); }
  void operator()(double t, double* value) const;

 private:
  std::vector<double> at_;
  Eigen::MatrixXd values_, second_;  // and second derivatives
};

/// A smooth map from u, in which a posterior is nearly standard normal, to its real line. It is
/// affine, or, for a funnel or a curved ridge, follows one coordinate (the axis): u[axis] moves
/// along the axis, and the others are measured from their conditional mode there in units of their
/// conditional widths. For up to `most` coordinates.
class RidgeMap {
 public:
  static constexpr int most = 4;
  using Coordinates = std::array<double, most>;

  /// Walks along the ridge unless `affine` is requested. Does not keep references.
  RidgeMap(const Posterior& posterior, const Whitening& whitening, bool affine = false);

  /// The map at u[axis] = t.
  struct Frame {
    Coordinates center;                     // z at zero for the other u
    std::array<double, most * most> scale;  // by column, of the other u
    double log_jacobian = 0;                // of z with respect to u, minus log_scale()
  };
  Frame at(double t) const;
  void to_real(const Frame& frame, const Coordinates& u, Coordinates& z) const;

  /// The u of a position on the real line.
  Coordinates from_real(const Eigen::VectorXd& z) const;
  /// Whether the walk passed this position along the axis.
  bool reaches(const Eigen::VectorXd& z) const;

  double log_scale() const { return log_scale_; }

  int axis() const { return axis_; }
  bool affine() const { return affine_; }

  /// The initial range of u[axis].
  double lower() const { return lower_; }
  double upper() const { return upper_; }

  /// The highest log density on the walk, and the log integral of the posterior from Laplace
  /// approximations at the stations; for an affine map the density at its center, and NaN.
  double highest() const { return highest_; }
  double log_integral() const { return log_integral_; }

  /// The highest log density where the marginal density is non-negligible, which excludes the neck
  /// of a funnel.
  double highest_of_weight() const { return highest_of_weight_; }

  /// The marginal density of a scale decreased too little over a hundred factors of e.
  bool endless() const { return endless_; }

 private:
  void choose_axis(const Posterior& posterior);
  std::vector<ConditionalMode> walk(const Posterior& posterior, int way) const;
  void follow(const Posterior& posterior);

  Whitening whitening_;
  int d_;
  int axis_ = 0;
  bool affine_ = true;
  double unit_ = 1;  // of u[axis] on the real line
  double log_scale_ = 0;
  bool endless_ = false;
  double lower_ = -6, upper_ = 6;
  double walked_from_ = 0, walked_to_ = 0;  // values of u[axis]
  double highest_, log_integral_, highest_of_weight_;
  Splines splines_;
};

}  // namespace wearwell
