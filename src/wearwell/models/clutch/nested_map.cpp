#include "wearwell/models/clutch/nested_map.h"

#include <algorithm>

#include "wearwell/regress/k_fold.h"

namespace wearwell::clutch {

using Eigen::Index;

WearPoints chosen(const WearPoints& points, const std::vector<Index>& rows) {
  WearPoints some;
  for (const Index row : rows) {
    const auto at = static_cast<std::size_t>(row);
    some.number.push_back(points.number[at]);
    some.at.push_back(points.at[at]);
    if (points.plate.empty()) continue;
    some.plate.push_back(points.plate[at]);
    some.from.push_back(points.from[at]);
    some.to.push_back(points.to[at]);
  }
  some.w = points.w(rows);
  some.cycles = points.cycles(rows);
  some.balance_sd = points.balance_sd(rows);
  if (points.factor.size() > 0) some.factor = points.factor(rows);
  return some;
}

Nested nested_map(const WearPoints& points, Surrogate surrogate,
                  const std::vector<double>& exponents, const std::vector<int>& start, int folds,
                  std::uint64_t seed, int threads, Progress* progress) {
  Eigen::VectorXd predicted(points.size());
  for (const std::vector<Index>& out : random_folds(points.size(), folds, seed, 0)) {
    std::vector<Index> seen;
    for (Index row = 0; row < points.size(); ++row) {
      if (std::find(out.begin(), out.end(), row) == out.end()) seen.push_back(row);
    }
    const WearPoints others = chosen(points, seen);
    const PairBest best =
        best_exponents(others, surrogate, exponents, start, threads, false, progress);
    const WearMap map = fit_map("nested", others, surrogate, best.r, best.q, 3, best.terms);
    predicted(out) = map.predict(chosen(points, out).at);
  }
  return nested_of(points.w, {}, predicted, folds);
}

}  // namespace wearwell::clutch
