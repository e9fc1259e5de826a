#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "wearwell/bayes/posterior.h"
#include "wearwell/infer/ridge.h"
#include "wearwell/infer/whitened.h"

namespace wearwell {

/// Cubic splines through points of a few values each: two continuous derivatives, straight beyond
/// the ends.
class Splines {
 public:
  Splines() = default;
  /// `at` ascends; two points or more; `values` has a row a point.
  Splines(std::vector<double> at, Eigen::MatrixXd values);

  Eigen::Index size() const { return values_.cols(); }
  void operator()(double t, double* value) const;

 private:
  std::vector<double> at_;
  Eigen::MatrixXd values_, second_;  // and second derivatives
};

/// A smooth map from u, where a posterior is round and of unit size, to its real line. Affine, or, where the
/// widths of the other coordinates change along one of them (the axis), as in a funnel, or the ridge
/// bends: u[axis] moves along the axis, the others are measured from their conditional mode there in
/// units of their conditional widths. For up to `most` coordinates.
class RidgeMap {
 public:
  static constexpr int most = 4;
  using Coordinates = std::array<double, most>;

  /// Walks along the ridge, unless it is to be affine. Refers to neither.
  RidgeMap(const Posterior& posterior, const Whitening& whitening, bool affine = false);

  /// The map where u[axis] is t.
  struct Frame {
    Coordinates center;                     // z where the other u are 0
    std::array<double, most * most> scale;  // by column, of the other u
    double log_jacobian = 0;                // of z by u, less log_scale()
  };
  Frame at(double t) const;
  void to_real(const Frame& frame, const Coordinates& u, Coordinates& z) const;

  /// The u of a place on the real line.
  Coordinates from_real(const Eigen::VectorXd& z) const;
  /// The walk has come by there, along the axis.
  bool reaches(const Eigen::VectorXd& z) const;

  double log_scale() const { return log_scale_; }

  int axis() const { return axis_; }
  bool affine() const { return affine_; }

  /// Between which values of u[axis] to begin.
  double lower() const { return lower_; }
  double upper() const { return upper_; }

  /// The highest log density met on the walk, and the log of the posterior's integral by Laplace's
  /// approximation, station by station; of an affine map the density at its center, and NaN.
  double highest() const { return highest_; }
  double log_integral() const { return log_integral_; }

  /// The highest log density met where the marginal density is of weight: not in the throat of a funnel.
  double highest_of_weight() const { return highest_of_weight_; }

  /// The marginal density of a scale hardly fell over a hundred factors of e.
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
