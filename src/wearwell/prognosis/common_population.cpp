#include "wearwell/prognosis/common_population.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/stop_scope.h"
#include "wearwell/prognosis/population_weights.h"

namespace wearwell::prognosis {
namespace {

double failed_by(double passed, const WeightedLives& remaining, double after) {
  if (passed >= 1 || remaining.points().empty()) return 1;
  return std::clamp(passed + (1 - passed) * remaining.cdf(after), 0.0, 1.0);
}

CommonPopulation independent(std::span<const KnownUnit* const> units, std::span<const double> after,
                             const std::string& why) {
  CommonPopulation common;
  common.why = why;
  common.failed.assign(1, std::vector<std::vector<double>>(after.size()));
  for (const KnownUnit* unit : units) {
    check_stop();
    for (std::size_t m = 0; m < after.size(); ++m)
      common.failed[0][m].push_back(failed_by(unit->passed, unit->remaining, after[m]));
  }
  return common;
}

}  // namespace

CommonPopulation in_common(const KnownLives& lives, std::span<const KnownUnit* const> units,
                           std::span<const double> after) {
  const std::size_t populations = lives.populations.size();
  if (populations < 2)
    return independent(
        units, after,
        fmt::format("these lives do not separate what {}s have in common", lives.noun));
  CommonPopulation common;
  common.failed.assign(populations, std::vector<std::vector<double>>(
                                        after.size(), std::vector<double>(units.size())));
  std::vector<double> log_likelihood(populations, 0);
  for (std::size_t u = 0; u < units.size(); ++u) {
    const std::optional<InPopulations> unit =
        units[u]->in_populations ? units[u]->in_populations() : std::nullopt;
    if (!unit) {
      CommonPopulation alone =
          independent(units, after,
                      fmt::format("there is no forecast by population for {} {} alone", lives.noun,
                                  units[u]->name));
      alone.outgrown = units[u]->in_populations != nullptr;
      return alone;
    }
    for (std::size_t k = 0; k < populations; ++k) {
      check_stop();
      log_likelihood[k] += unit->log_likelihood[k];
      for (std::size_t m = 0; m < after.size(); ++m)
        common.failed[k][m][u] = failed_by(unit->passed[k], unit->remaining[k], after[m]);
    }
  }
  PopulationWeights given = weights_given(lives.populations, log_likelihood);
  common.weight = std::move(given.weight);
  common.effective = given.effective;
  if (given.resolved) return common;
  CommonPopulation alone =
      independent(units, after,
                  fmt::format("the readings since the study are more informative on the population "
                              "than its {} points resolve (effective number {:.1f})",
                              populations, common.effective));
  alone.outgrown = true;
  return alone;
}

}  // namespace wearwell::prognosis
