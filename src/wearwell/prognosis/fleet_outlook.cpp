#include "wearwell/prognosis/fleet_outlook.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/root.h"

namespace wearwell::prognosis {
namespace {

constexpr std::size_t most_ages = 1000;
// Survival of a distribution by points beyond the last of them is a rounding error.
constexpr double none_survive = 1e-9;

// All ages, or some from the first to the last: half of them equally many units apart, half equally
// far apart.
std::vector<double> chosen_ages(std::vector<double> ages) {
  std::sort(ages.begin(), ages.end());
  std::vector<double> all = ages;
  all.erase(std::unique(all.begin(), all.end()), all.end());
  if (all.size() <= most_ages) return all;
  std::vector<double> some;
  constexpr std::size_t half = most_ages / 2;
  for (std::size_t i = 0; i <= half; ++i) {
    some.push_back(ages[i * (ages.size() - 1) / half]);
    some.push_back(std::lerp(ages.front(), ages.back(), static_cast<double>(i) / half));
  }
  std::sort(some.begin(), some.end());
  some.erase(std::unique(some.begin(), some.end()), some.end());
  return some;
}

// The numbers of units of one age.
struct AtAge {
  std::vector<double> failing;             // by horizon
  std::vector<std::vector<double>> apart;  // by horizon, by population
  std::vector<double> log_survival;        // by population
  double b10 = 0, median = 0;
};

// The remaining life by which this share has failed; `failed` increases with it.
template <class Failed>
double remaining_life(const PopulationLives& lives, double age, double share,
                      const Failed& failed) {
  double last = 0;
  for (const WeightedLives& each : lives.lives) {
    for (std::size_t i = each.points().size(); i-- > 0;) {
      if (!std::isfinite(each.points()[i])) continue;
      last = std::max(last, each.points()[i] - age);
      break;
    }
  }
  if (!(last > 0)) return 0;
  const auto missing = [&](double life) { return failed(life) - share; };
  if (missing(last) < 0) return infinity;
  return solve_increasing(missing, 0.5 * last, 0.5 * last, {0, 1e-9}, 0, last);
}

AtAge at_age(const PopulationLives& lives, double age, bool in_study,
             std::span<const double> horizons) {
  check_stop();
  const std::size_t populations = lives.lives.size();
  AtAge found;
  std::vector<double> survival(populations), weight(populations);
  double mass = 0;
  for (std::size_t k = 0; k < populations; ++k) {
    survival[k] = 1 - lives.lives[k].cdf(age);
    if (survival[k] < none_survive) survival[k] = 0;
    // That the study has the unit's survival leaves no weight to a population in which none survives,
    // but for the few points that represent the posterior.
    const bool none = survival[k] == 0;
    found.log_survival.push_back(none ? -infinity : in_study ? 0 : std::log(survival[k]));
    weight[k] = none ? 0 : lives.weight[k] * (in_study ? 1 : survival[k]);
    mass += weight[k];
  }
  const auto failed_in = [&](std::size_t k, double life) {
    if (survival[k] == 0) return 1.0;
    return std::clamp((lives.lives[k].cdf(age + life) - 1 + survival[k]) / survival[k], 0.0, 1.0);
  };
  const auto failed = [&](double life) {
    double sum = 0;
    for (std::size_t k = 0; k < populations; ++k)
      if (weight[k] > 0) sum += weight[k] * failed_in(k, life);
    return sum / mass;
  };
  for (const double horizon : horizons) {
    std::vector<double>& apart = found.apart.emplace_back();
    for (std::size_t k = 0; k < populations; ++k) apart.push_back(failed_in(k, horizon));
    found.failing.push_back(failed(horizon));
  }
  found.b10 = remaining_life(lives, age, 0.1, failed);
  found.median = remaining_life(lives, age, 0.5, failed);
  return found;
}

// Units that share lives, and whether the study has them.
struct Part {
  std::uint32_t group = 0;
  bool in_study = false;
  std::vector<std::size_t> units = {};
};

std::vector<Part> parts_of(const UnitsInService& units) {
  std::map<std::pair<std::uint32_t, bool>, std::size_t> place;
  std::vector<Part> parts;
  for (std::size_t u = 0; u < units.count(); ++u) {
    const bool in_study = units.in_study[u] != 0;
    const auto [at, is_new] = place.try_emplace({units.group[u], in_study}, parts.size());
    if (is_new) parts.push_back({units.group[u], in_study});
    parts[at->second].units.push_back(u);
  }
  return parts;
}

double between(double low, double high, double share) {
  if (share <= 0 || low == high) return low;
  return share >= 1 ? high : std::lerp(low, high, share);
}

void add_part(const PopulationLives& lives, const UnitsInService& units, const Part& part,
              std::span<const double> horizons, FleetOutlook& outlook, FailureTotals& totals,
              std::vector<double>& log_likelihood) {
  std::vector<double> own;
  for (const std::size_t u : part.units) own.push_back(units.age[u]);
  const std::vector<double> ages = chosen_ages(std::move(own));
  std::vector<AtAge> at(ages.size());
  tbb::parallel_for(std::size_t{0}, ages.size(), [&](std::size_t i) {
    at[i] = at_age(lives, ages[i], part.in_study, horizons);
  });
  std::vector<double> count(ages.size(), 0);
  for (const std::size_t u : part.units) {
    const double age = units.age[u];
    const auto above = std::lower_bound(ages.begin(), ages.end(), age);
    const auto j = static_cast<std::size_t>(above - ages.begin());
    const std::size_t i = *above == age ? j : j - 1;
    const double share = i == j ? 0 : (age - ages[i]) / (ages[j] - ages[i]);
    outlook.interpolated |= i != j;
    for (std::size_t h = 0; h < horizons.size(); ++h)
      outlook.failing[h][u] = between(at[i].failing[h], at[j].failing[h], share);
    outlook.b10[u] = between(at[i].b10, at[j].b10, share);
    outlook.median[u] = between(at[i].median, at[j].median, share);
    count[i] += 1 - share;
    if (i != j) count[j] += share;
    totals.keep(at[i].apart);
  }
  for (std::size_t i = 0; i < ages.size(); ++i) {
    if (!(count[i] > 0)) continue;
    totals.add(at[i].apart, count[i]);
    for (std::size_t k = 0; k < log_likelihood.size(); ++k)
      log_likelihood[k] += count[i] * at[i].log_survival[k];
  }
}

}  // namespace

bool some_survive(const PopulationLives& lives, double age) {
  double survival = 0;
  for (std::size_t k = 0; k < lives.lives.size(); ++k)
    if (lives.weight[k] > 0) survival = std::max(survival, 1 - lives.lives[k].cdf(age));
  return survival >= none_survive;
}

FleetOutlook fleet_outlook(std::span<const PopulationLives> groups, const UnitsInService& units,
                           std::span<const double> horizons) {
  FleetOutlook outlook;
  outlook.failing.assign(horizons.size(), std::vector<double>(units.count()));
  outlook.b10.resize(units.count());
  outlook.median.resize(units.count());
  const std::vector<double>& prior = groups.front().weight;
  FailureTotals totals(horizons.size(), prior.size());
  std::vector<double> log_likelihood(prior.size(), 0);
  for (const Part& part : parts_of(units))
    add_part(groups[part.group], units, part, horizons, outlook, totals, log_likelihood);
  outlook.population = weights_given(prior, log_likelihood);
  const std::vector<double>& weight =
      outlook.population.resolved ? outlook.population.weight : prior;
  for (std::size_t h = 0; h < horizons.size(); ++h)
    outlook.failures.push_back(totals.failures(h, weight));
  return outlook;
}

}  // namespace wearwell::prognosis
