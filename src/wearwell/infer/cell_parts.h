#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "wearwell/bayes/weighted_draws.h"
#include "wearwell/math/quadrature.h"

namespace wearwell {

/// Splits a box with a density at the nodes of a product of Gauss-Legendre rules into one cell per
/// node, between the rule's cell edges along every axis, and integrates the polynomial through the
/// nodes over each cell. Distributions computed from the cells then keep the quadrature's means and
/// variances.
class CellParts {
 public:
  CellParts(const GaussLegendre& rule, int dimension);

  /// Fills rows `row`, `row` + 1, ... of `cells` for the nodes `kept` of a box: `values` are the
  /// density at all of its nodes, the first axis fastest, `volume` is the box's over 2^dimension.
  void describe(std::span<const double> values, const std::vector<std::size_t>& kept, double volume,
                Eigen::Index row, WeightedDraws::Cells& cells) const;

 private:
  Eigen::VectorXd applied(std::span<const double> values, int which,
                          const Eigen::MatrixXd& matrix) const;
  double node_weight(std::size_t index) const;

  int d_, p_;
  GaussLegendre rule_;
  // Row i of each matrix times a polynomial's values at the nodes of [-1, 1] is the integral over
  // part i of the polynomial, and of the polynomial times the position in the part (-1/2 to 1/2)
  // and its square.
  Eigen::MatrixXd mass_, mean_, square_;
  Eigen::VectorXd node_;  // position of the node in its part
};

}  // namespace wearwell
