#pragma once

#include <Eigen/Dense>
#include <functional>
#include <span>
#include <vector>

#include "wearwell/base/rng.h"

namespace wearwell {

/// A matrix whose rows are contiguous: one row a point.
using Points = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A posterior as weighted points: the draws of a sampler, all of one weight, or the nodes of a
/// quadrature. A node stands for a cell; `lower` and `upper` hold, for each axis of the
/// integration, the points where the cell ends.
struct WeightedDraws {
  Points values;              ///< points x parameters, natural, SI
  Eigen::VectorXd weights;    ///< sum to 1
  std::vector<Points> lower;  ///< one per axis, like `values`; empty for draws
  std::vector<Points> upper;
  /// What each cell holds when its mass is spread evenly over it, where that is not its node's
  /// weight; sum to 1. Given for nodes in the middle of their cells.
  Eigen::VectorXd cell_weights = {};

  bool centered() const { return cell_weights.size() > 0; }

  /// The weight of point i where it stands for its cell.
  double cell_weight(Eigen::Index i) const {
    return cell_weights.size() > 0 ? cell_weights[i] : weights[i];
  }
};

/// The distribution of one number: points, each spread evenly over center +- half_width (0 for
/// draws). Nodes of a quadrature without weight do not count; where the number is NaN with more
/// than 1e-8 of the weight it has no distribution, and all that is asked of it is NaN.
class Distribution {
 public:
  Distribution(const WeightedDraws& draws, const std::function<double(const double* x)>& quantity);

  double mean() const;
  double sd() const;
  double cdf(double x) const;

  /// The x with cdf(x) = p. For draws, R's type 7 (linear between order statistics).
  double quantile(double p) const;

 private:
  // Sorted by center; points at infinity (a life that never ends) come last.
  std::vector<double> center_, half_width_, weight_;
  bool cells_ = false;
};

/// One draw: a point by its weight, then evenly within its cell.
class WeightedSampler {
 public:
  explicit WeightedSampler(const WeightedDraws& draws);
  Eigen::VectorXd operator()(Rng& rng) const;

 private:
  const WeightedDraws& draws_;
  std::vector<double> cumulated_;
};

}  // namespace wearwell
