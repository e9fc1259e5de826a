#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cells.h"
#include "support/between.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// Of so many cells that they stand in sections: against a plain sum over all. Some of them over thirty decades, some at either
// infinity. Those that together weigh 1e-8 are left out.
RC_GTEST_PROP(QuantityDistribution, OfManyCellsIsTheirSum, ()) {
  constexpr std::size_t n = 3000;
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::normal_distribution<double> normal;
  const double decades = *between(0.1, 15);
  const bool endless = *rc::gen::arbitrary<bool>();
  std::vector<Cell> cells;
  double total = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double at = std::pow(10, decades * normal(random)), width = 0.2 * at,
                 weight = std::exp(3 * normal(random));
    cells.push_back({at - width, at, at + width, weight});
    if (endless && i % 10 == 0) cells.back() = {infinity, infinity, infinity, weight};
    if (endless && i % 25 == 1) cells.back() = {-infinity, -infinity, -infinity, weight};
    total += weight;
  }
  double below = 0, above = 0;
  for (Cell& each : cells) {
    each.weight /= total;
    if (each.node == -infinity) below += each.weight;
    if (each.node == infinity) above += each.weight;
  }
  const QuantityDistribution d(cells_of(cells), itself);
  for (const double p : {0.003, 0.05, 0.3, 0.5, 0.95, 0.9995}) {
    const double x = d.quantile(p);
    if (p < below || p > 1 - above) {
      RC_ASSERT(x == (p < below ? -infinity : infinity));
      continue;
    }
    double sum = 0;
    for (const Cell& each : cells) {
      const double share = (x - each.lower) / (each.upper - each.lower);
      sum += each.weight * (std::isfinite(each.node) ? std::clamp(share, 0.0, 1.0)
                            : each.node < x          ? 1
                                                     : 0);
    }
    RC_ASSERT(std::abs(d.cdf(x) - sum) < 1e-8);
    RC_ASSERT(std::abs(sum - p) < 1e-8);
  }
}

}  // namespace
}  // namespace wearwell
