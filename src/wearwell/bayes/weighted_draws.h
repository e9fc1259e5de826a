#pragma once

#include <Eigen/Dense>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "wearwell/base/rng.h"

namespace wearwell {

/// A matrix with contiguous rows, one row per point.
using Points = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A posterior as weighted points: draws of a sampler with equal weights, or nodes of a quadrature.
/// A node represents a cell; `lower` and `upper` contain the ends of the cell along each axis of
/// the integration. Sums over `weights` have the accuracy of the quadrature; distributions are
/// computed from the cells. Nodes from `lower[0].rows()` on have little weight and no cells;
/// earlier cells represent their mass.
struct WeightedDraws {
  Points values;              ///< points x parameters, natural, SI
  Eigen::VectorXd weights;    ///< sum to 1
  std::vector<Points> lower;  ///< one per axis, shaped like `values`; empty for draws
  std::vector<Points> upper;

  /// More accurate content of the cells than weight and middle.
  struct Cells {
    Eigen::VectorXd mass;  ///< of each cell; sum to 1
    /// Points x axes, in cell lengths from -1/2 to 1/2: the node, the mean of the mass, and its
    /// mean square about the middle.
    Points node, mean, square;
  };
  Cells cells = {};

  bool has_cells() const { return cells.mass.size() > 0; }

  /// The weight of point i as the representative of its cell.
  double cell_weight(Eigen::Index i) const {
    if (!has_cells()) return weights[i];
    return i < cells.mass.size() ? cells.mass[i] : 0;
  }
};

/// The distribution of one number, in the unit of that number: points, each spread evenly over
/// center +- half_width (0 for draws), which keep mean and variance of their cells. Nodes of a
/// quadrature without weight do not count; where the number is NaN with more than 1e-8 of the weight
/// it has no distribution, and mean, sd, cdf and quantile are NaN.
class QuantityDistribution {
 public:
  QuantityDistribution() = default;
  /// `quantity` of the natural parameters, SI: an array of `draws.values.cols()` entries.
  QuantityDistribution(const WeightedDraws& draws,
                       const std::function<double(const double* x)>& quantity);

  /// Points up to this weight are ignored.
  static double least_weight(const WeightedDraws& draws);

  double mean() const;
  double sd() const;
  double cdf(double x) const;

  /// The x with cdf(x) = p, 0 <= p <= 1. For draws, R's type 7 (linear between order statistics).
  double quantile(double p) const;

  /// Calls back with the weight, the center and the half width of each point; never where the number
  /// has no distribution.
  void visit(
      const std::function<void(double weight, double center, double half_width)>& each) const;

 private:
  // Points before those of the next section; unordered within.
  struct Section {
    std::size_t end;
    double low, high;  // range of their cells
    double weight;
  };
  // The cell of a section at which its cumulative weight reaches the given weight, or its last
  // cell.
  std::size_t cell_at(const Section& section, double weight) const;

  // Draws are sorted; cells are ordered by section. Cells at infinity (a life that never ends) come
  // after all sections.
  std::vector<double> center_, half_width_, weight_;
  std::vector<Section> sections_;
  bool cells_ = false;
  double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_;  // of all values
};

/// One draw: a point by its weight, then a position within its cell by a density linear along each
/// axis.
class WeightedSampler {
 public:
  /// `draws` must outlive the sampler.
  explicit WeightedSampler(const WeightedDraws& draws);
  /// Natural parameters, SI.
  Eigen::VectorXd operator()(Rng& rng) const;

 private:
  const WeightedDraws& draws_;
  std::vector<double> cumulated_;
};

}  // namespace wearwell
