#include "wearwell/prognosis/common_population.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"

namespace wearwell::prognosis {
namespace {

// The smallest number of populations that must carry the weight given the readings of all units;
// half of the initial number if that is smaller.
constexpr double least_effective = 50;

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

// Normalizes the weights; returns their effective sample size.
double normalized(const std::vector<double>& log_weight, std::vector<double>& weight) {
  const double top = *std::max_element(log_weight.begin(), log_weight.end());
  weight.clear();
  double sum = 0, square = 0;
  for (const double each : log_weight) sum += weight.emplace_back(std::exp(each - top));
  for (double& each : weight) {
    each /= sum;
    square += each * each;
  }
  return 1 / square;
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
  std::vector<double> log_weight;
  for (const double each : lives.populations) log_weight.push_back(std::log(each));
  const double before = normalized(log_weight, common.weight);
  bool shown = false;
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
      log_weight[k] += unit->log_likelihood[k];
      shown |= unit->log_likelihood[k] != 0;
      for (std::size_t m = 0; m < after.size(); ++m)
        common.failed[k][m][u] = failed_by(unit->passed[k], unit->remaining[k], after[m]);
    }
  }
  const bool possible = std::any_of(log_weight.begin(), log_weight.end(),
                                    [](double each) { return each > -infinity; });
  common.effective = possible ? normalized(log_weight, common.weight) : 0;
  if (!shown || common.effective >= std::min(least_effective, 0.5 * before)) return common;
  CommonPopulation alone =
      independent(units, after,
                  fmt::format("the readings since the study are more informative on the population "
                              "than its {} points resolve (effective number {:.1f})",
                              populations, common.effective));
  alone.outgrown = true;
  return alone;
}

}  // namespace wearwell::prognosis
