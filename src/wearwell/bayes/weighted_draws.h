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
/// integration, the points where the cell ends. Sums over `weights` are as exact as the quadrature;
/// distributions are read off the cells. Nodes from `lower[0].rows()` on have little weight and no
/// cells: others before them stand for theirs.
struct WeightedDraws {
  Points values;              ///< points x parameters, natural, SI
  Eigen::VectorXd weights;    ///< sum to 1
  std::vector<Points> lower;  ///< one per axis, like `values`; empty for draws
  std::vector<Points> upper;

  /// What lies in the cells, where it is known better than by the weights and the middle.
  struct Cells {
    Eigen::VectorXd mass;  ///< of each cell; sum to 1
    /// Points x axes, in cell lengths from -1/2 to 1/2: where the node lies, where the mass lies in
    /// the mean, and its mean square about the middle.
    Points node, mean, square;
  };
  Cells cells = {};

  bool has_cells() const { return cells.mass.size() > 0; }

  /// The weight of point i where it stands for its cell.
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

  /// Points of no more weight than this do not count.
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
  // Points that lie before those of the next; sums need no order among them.
  struct Section {
    std::size_t end;
    double low, high;  // between which their cells lie
    double weight;
  };
  // The cell of a section that, with those before it there, reaches so much weight; or its last.
  std::size_t cell_at(const Section& section, double weight) const;

  // Draws are sorted; cells from section to section. Cells at infinity (a life that never ends) come behind all sections.
  std::vector<double> center_, half_width_, weight_;
  std::vector<Section> sections_;
  bool cells_ = false;
};

/// One draw: a point by its weight, then a place within its cell, by a density linear along each axis.
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
