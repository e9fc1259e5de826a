#include "wearwell/prognosis/replacement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/math/root.h"
#include "wearwell/prognosis/least.h"
#include "wearwell/prognosis/survival_sweep.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::prognosis {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr double as_good = 1.01;
// Savings below this share may be an artefact of points that stand for a density.
constexpr double no_saving = 1.001;

double infinite_share(const WeightedLives& lives) {
  double share = 0;
  for (std::size_t i = lives.points().size(); i-- > 0 && !std::isfinite(lives.points()[i]);)
    share += lives.weights()[i];
  return share;
}

// The end of the last finite life; all lie before.
double last_of(const WeightedLives& lives) {
  return lives.quantile((1 - infinite_share(lives)) * (1 - 1e-12));
}
double behind_all(const WeightedLives& lives) {
  return 4 * lives.points().back();
}

double rate_of(const WeightedLives& lives, const Costs& costs, double age) {
  if (!std::isfinite(age)) {
    if (infinite_share(lives) > 0) return 0;
    age = behind_all(lives);
  }
  const double failed = lives.cdf(age);
  const double lived = lives.mean_up_to(age);
  return (costs.replacement * (1 - failed) + costs.failure * failed) / lived;
}

// The first and last age whose rate is at most 1 % above the least, to 1e-6 of the age.
template <class Rate>
void find_range(const Rate& rate, double age, std::vector<double> ages, AgeReplacement& best) {
  const auto is_good = [&](double x) { return rate(x) <= as_good * best.rate; };
  ages.insert(std::upper_bound(ages.begin(), ages.end(), age), age);
  std::size_t first = ages.size(), last = 0;
  for (std::size_t i = 0; i < ages.size(); ++i) {
    if (ages[i] != age && !is_good(ages[i])) continue;
    first = std::min(first, i);
    last = i;
  }
  const auto end = [&](double good, double bad) {
    while (std::abs(good - bad) > 1e-6 * good) {
      const double middle = 0.5 * (good + bad);
      (is_good(middle) ? good : bad) = middle;
    }
    return good;
  };
  best.from = first > 0 ? end(ages[first], ages[first - 1]) : ages[first];
  best.to = last + 1 < ages.size() ? end(ages[last], ages[last + 1]) : ages[last];
}

}  // namespace

// Points of all populations together are a distribution in steps where populations are alike: they
// only say where its survival is to be known.
WeightedLives PopulationLives::mixture() const {
  if (lives.size() == 1) return lives.front();
  std::vector<double> all, share;
  for (std::size_t k = 0; k < lives.size(); ++k) {
    const auto points = lives[k].points(), weights = lives[k].weights();
    for (std::size_t i = 0; i < points.size(); ++i) {
      all.push_back(points[i]);
      share.push_back(weight[k] * weights[i]);
    }
  }
  const WeightedLives together(all, share);
  if (together.points().empty()) return together;
  const WeightedLives places = represented_lives([&](double p) { return together.quantile(p); });
  std::vector<double> life;
  for (const double x : places.points())
    if (std::isfinite(x)) life.push_back(x);
  if (life.empty()) return together;
  std::vector<double> failed = survivals(*this, life);
  for (double& each : failed) each = 1 - each;
  const double last = infinite_share(together) > 0 ? never : life.back();
  return represented_lives([&](double p) {
    const auto above = std::lower_bound(failed.begin(), failed.end(), p);
    if (above == failed.begin()) return life.front();
    if (above == failed.end()) return last;
    const auto i = static_cast<std::size_t>(above - failed.begin());
    return std::lerp(life[i - 1], life[i], (p - failed[i - 1]) / (failed[i] - failed[i - 1]));
  });
}

double PopulationLives::survival(double x) const {
  double sum = 0, mass = 0;
  for (std::size_t k = 0; k < lives.size(); ++k) {
    sum += weight[k] * (1 - lives[k].cdf(x));
    mass += weight[k];
  }
  return sum / mass;
}

double PopulationLives::quantile(double p) const {
  double low = never, high = 0, last = 0;
  for (std::size_t k = 0; k < lives.size(); ++k) {
    if (!(weight[k] > 0) || lives[k].points().empty()) continue;
    const double each = lives[k].quantile(p);
    low = std::min(low, each);
    high = std::max(high, each);
    if (infinite_share(lives[k]) < 1) last = std::max(last, last_of(lives[k]));
  }
  if (!(low < high)) return high > 0 || low == 0 ? low : std::nan("");
  const auto failed = [&](double x) { return 1 - survival(x) - p; };
  if (!std::isfinite(high)) {
    if (failed(last) < 0) return never;
    high = last;
  }
  return solve_increasing(failed, 0.5 * (low + high), 0.5 * (high - low), {0, 1e-10}, low, high);
}

double cost_rate(const PopulationLives& lives, const Costs& costs, double age) {
  double sum = 0, mass = 0;
  for (std::size_t k = 0; k < lives.lives.size(); ++k) {
    sum += lives.weight[k] * rate_of(lives.lives[k], costs, age);
    mass += lives.weight[k];
  }
  return sum / mass;
}

AgeReplacement cheapest_age(const PopulationLives& lives, const Costs& costs) {
  const std::vector<double> ages = ages_of(lives.lives);
  const auto rate = [&](double age) { return cost_rate(lives, costs, age); };
  const Least least = least_of(rate, ages);
  AgeReplacement best;
  best.at_failure = rate(never);
  const bool some_never = std::any_of(lives.lives.begin(), lives.lives.end(),
                                      [](const auto& each) { return infinite_share(each) > 0; });
  best.age = least.at;
  best.rate = least.value;
  // Where none is left the rate is that of replacement at failure.
  if (!some_never && best.at_failure <= best.rate * no_saving) {
    best.age = never;
    best.rate = best.at_failure;
  }
  best.beyond_known = some_never && best.age >= ages.back() * (1 - 1e-9);
  best.failing = 1 - lives.survival(best.age);
  find_range(rate, std::min(best.age, ages.back()), ages, best);
  if (!some_never && best.at_failure <= as_good * best.rate) best.to = never;
  return best;
}

void estimate_errors(AgeReplacement& age, const AgeReplacement& coarse) {
  age.age_error = 2 * relative_difference(age.age, coarse.age, age.age);
  age.rate_error = 2 * relative_difference(age.rate, coarse.rate, age.rate);
}

double moment_cost(const WeightedLives& remaining, const Costs& costs, double rate, double after) {
  if (!std::isfinite(after)) {
    if (infinite_share(remaining) > 0)
      return rate > 0 ? -never : costs.failure * (1 - infinite_share(remaining));
    after = behind_all(remaining);
  }
  const double failed = remaining.cdf(after);
  return costs.replacement * (1 - failed) + costs.failure * failed -
         rate * remaining.mean_up_to(after);
}

UnitReplacement cheapest_moment(const WeightedLives& remaining, const Costs& costs, double rate) {
  std::vector<double> moments = ages_of({&remaining, 1}, 120);
  moments.insert(moments.begin(), 0);
  const auto cost = [&](double after) { return moment_cost(remaining, costs, rate, after); };
  const Least least = least_of(cost, moments);
  UnitReplacement best;
  best.now = costs.replacement;
  best.waiting = cost(never);
  best.after = least.at;
  best.cost = least.value;
  if (best.now <= best.cost + (no_saving - 1) * costs.replacement) {
    best.after = 0;
    best.cost = best.now;
  }
  const double flat = (no_saving - 1) * costs.replacement;
  if (best.after > 0 && best.waiting <= best.cost + flat && infinite_share(remaining) == 0) {
    best.after = never;
    best.cost = best.waiting;
  }
  best.failing = remaining.cdf(best.after);
  if (best.after == 0) best.failing = 0;
  return best;
}

UnitReplacement replacement_by_age(const PopulationLives& fresh, const PopulationLives& remaining,
                                   const Costs& costs, double now, double best_age) {
  std::vector<double> rates;
  for (const WeightedLives& each : fresh.lives) {
    const PopulationLives one(each);
    rates.push_back(std::min(cost_rate(one, costs, best_age), cost_rate(one, costs, never)));
  }
  const auto cost = [&](double after) {
    double sum = 0, mass = 0;
    for (std::size_t k = 0; k < rates.size(); ++k) {
      if (!(remaining.weight[k] > 0) || remaining.lives[k].points().empty()) continue;
      sum += remaining.weight[k] * moment_cost(remaining.lives[k], costs, rates[k], after);
      mass += remaining.weight[k];
    }
    return sum / mass;
  };
  UnitReplacement best;
  best.now = costs.replacement;
  best.waiting = cost(never);
  best.after = now < best_age ? best_age - now : best.waiting < best.now ? never : 0;
  best.cost = best.after == 0             ? best.now
              : std::isfinite(best.after) ? cost(best.after)
                                          : best.waiting;
  best.failing = best.after == 0 ? 0 : 1 - remaining.survival(best.after);
  return best;
}

std::vector<double> ages_of(std::span<const WeightedLives> lives, std::size_t most) {
  std::vector<double> all;
  for (const WeightedLives& each : lives) {
    const auto points = each.points();
    const std::size_t finite = static_cast<std::size_t>(
        std::lower_bound(points.begin(), points.end(), never) - points.begin());
    if (finite == 0) continue;
    // Few points make up the tails: evenly by probability, more finely at the start.
    const double reach = 1 - infinite_share(each);
    const std::size_t count = std::max<std::size_t>(8, most / lives.size());
    for (std::size_t i = 1; i < count; ++i) {
      const double p = static_cast<double>(i) / static_cast<double>(count);
      all.push_back(each.quantile(reach * p));
      all.push_back(each.quantile(reach * p * p * p));
    }
    all.push_back(last_of(each));
    for (int i = 1; i <= 8; ++i) all.push_back(each.quantile(reach * std::pow(10.0, -i)));
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::erase_if(all, [](double x) { return !(x > 0) || !std::isfinite(x); });
  if (all.empty()) return {1};
  if (all.size() <= 2 * most) return all;
  std::vector<double> few;
  for (std::size_t i = 0; i < 2 * most; ++i)
    few.push_back(all[i * (all.size() - 1) / (2 * most - 1)]);
  few.erase(std::unique(few.begin(), few.end()), few.end());
  return few;
}

}  // namespace wearwell::prognosis
