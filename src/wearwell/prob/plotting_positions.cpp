#include "wearwell/prob/plotting_positions.h"

#include "wearwell/base/stop_scope.h"
#include "wearwell/prob/survival_estimate.h"

namespace wearwell {

std::vector<PlottingPosition> plotting_positions(std::span<const Response> responses,
                                                 std::span<const int> counts) {
  const SurvivalEstimate estimate = survival_estimate(responses, counts);
  const bool intervals = estimate.method == SurvivalMethod::turnbull;
  std::vector<PlottingPosition> all;
  double before = 1;
  for (const SurvivalStep& step : estimate.steps) {
    check_stop();
    if (!intervals) {
      all.push_back({step.at, 1 - 0.5 * (before + step.survival)});
    } else if (step.survival > 0) {
      all.push_back({step.at, 1 - step.survival});
    }
    before = step.survival;
  }
  return all;
}

}  // namespace wearwell
