#pragma once

#include <vector>

namespace wearwell {

/// Gauss-Legendre rule on [-1, 1]: exact for polynomials up to degree 2n - 1. All weights are
/// positive, and the cumulated weights cut [-1, 1] into cells with one node each
/// (Chebyshev-Markov-Stieltjes), so a node can represent its cell.
struct GaussLegendre {
  std::vector<double> node;
  std::vector<double> weight;     ///< sums to 2
  std::vector<double> cell_edge;  ///< n + 1 edges, from -1 to 1
};

/// The rule with n nodes (n >= 1), computed to rounding error.
GaussLegendre gauss_legendre(int n);

}  // namespace wearwell
