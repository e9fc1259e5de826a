#pragma once

#include <vector>

#include "wearwell/bayes/weighted_draws.h"

namespace wearwell {

inline double itself(const double* x) {
  return x[0];
}

struct Cell {
  double lower, node, upper, weight;
};

inline WeightedDraws cells_of(const std::vector<Cell>& cells) {
  const auto n = static_cast<Eigen::Index>(cells.size());
  WeightedDraws draws{Points(n, 1), Eigen::VectorXd(n), {Points(n, 1)}, {Points(n, 1)}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Cell& cell = cells[static_cast<std::size_t>(i)];
    draws.values(i, 0) = cell.node;
    draws.lower[0](i, 0) = cell.lower;
    draws.upper[0](i, 0) = cell.upper;
    draws.weights[i] = cell.weight;
  }
  return draws;
}

}  // namespace wearwell
