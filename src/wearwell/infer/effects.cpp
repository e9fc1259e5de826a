#include "wearwell/infer/effects.h"

#include <fmt/format.h>

#include <algorithm>

namespace wearwell {

std::vector<StageDiagnostic> unsettled_effects(const Posterior& posterior,
                                               const WeightedDraws& points) {
  constexpr int most = 200;
  constexpr double of_import = 1e-3;  // in the log likelihood, as of rounding (conditioning.cpp)
  int looked = 0, open = 0;
  double worst = 0, sum = 0;
  for (Eigen::Index i = 0; i < points.values.rows() && looked < most; ++i) {
    sum += points.weights[i];
    if (!(sum * most > looked + 0.5)) continue;
    while (looked < most && sum * most > looked + 0.5) ++looked;
    const Eigen::VectorXd x = points.values.row(i);
    const double left =
        posterior.likelihood()->unsettled({x.data(), static_cast<std::size_t>(x.size())});
    open += left > 0;
    worst = std::max(worst, left);
  }
  if (open == 0) return {};
  return {
      {Stage::effects, worst > of_import ? Verdict::fail : Verdict::warn,
       fmt::format("in {} of {} points of the posterior looked at what differs from unit to unit, "
                   "or a path under noise, is integrated out to {:.1g} of the log likelihood only",
                   open, looked, worst),
       "An expression with a jump or a corner (where, min, max, abs) in what differs is hard to "
       "integrate: write it smoothly. Paths under noise are where errors are far from steps."}};
}

}  // namespace wearwell
