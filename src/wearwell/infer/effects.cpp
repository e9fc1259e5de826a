#include "wearwell/infer/effects.h"

#include <fmt/format.h>

#include <algorithm>

namespace wearwell {

std::vector<StageDiagnostic> unsettled_effects(const Posterior& posterior,
                                               const WeightedDraws& points) {
  constexpr int most = 200;
  constexpr double of_import = 1e-3;  // tolerated error of the log likelihood, as for rounding
                                      // (conditioning.cpp)
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
       fmt::format("at {} of {} sampled points of the posterior the integral over random effects, "
                   "or over a noisy path, has an error of {:.1g} in the log likelihood",
                   open, looked, worst),
       "A jump or a kink (where, min, max, abs) in a random effect is hard to integrate: write a "
       "smooth expression. For noisy paths the integral is hard if reading errors and steps have "
       "very unlike sizes."}};
}

}  // namespace wearwell
