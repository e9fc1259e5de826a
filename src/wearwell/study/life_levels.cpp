#include "wearwell/study/life_levels.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/predict/item_mixture.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {

LifeLevels read_life_levels(const TomlReader& predict) {
  LifeLevels levels;
  for (const Quantity& each : predict.quantities("b_lives", "1")) {
    // "10 %" is a fraction in SI; a plain 10 is a percentage, as in B10.
    const double value = each.unit.text == "1" ? each.value : 100 * each.si();
    if (!(value > 0 && value < 100)) {
      predict.fail("b_lives", "are percentages between 0 and 100, like [1, 10]");
    }
    levels.percents.push_back(value);
  }
  if (const auto level = predict.quantity("credible_level", "1")) {
    if (!(level->si() > 0 && level->si() < 1)) {
      predict.fail("credible_level", "must lie between 0 and 1 (or 0 % and 100 %)");
    }
    levels.credible_level = level->si();
    if (levels.percents.empty()) levels.percents = {1, 10};
  }
  return levels;
}

std::string b_life_name(double percent, const std::string& life) {
  return fmt::format("B{:.6g} {}", percent, life);
}

QuantityRequest b_life_request(double percent, const LifeLevels& levels,
                               const QuantityRequest& life, const std::string& of) {
  QuantityRequest request{b_life_name(percent, life.name),
                          of.empty() ? life.of : of,
                          life.at,
                          life.unit,
                          true,
                          false,
                          {},
                          {},
                          {}};
  request.credible_level = levels.credible_level;
  request.safe_end = 0.05;
  return request;
}

QuantityGroup b_lives_of_one(const LifeRequest& life, const std::string& of, const std::string& at,
                             const LifeLevels& levels) {
  QuantityGroup group;
  const QuantityRequest all{"life", of, at, Unit{life.unit_name, 1, 0}, true, false, {}, {}, {}};
  for (const double percent : levels.percents) {
    group.requests.push_back(b_life_request(percent, levels, all));
  }
  group.from_draws = [levels, law_of = life.distribution](const WeightedDraws& draws) {
    const LifeDistribution distribution = law_of(draws);
    std::vector<QuantityQuantiles> found;
    for (const double percent : levels.percents) {
      found.push_back(b_life(distribution, distribution.quantile(percent / 100), levels));
    }
    return found;
  };
  return group;
}

QuantityGroup b_lives_of_items(const QuantityRequest& life, const std::string& of,
                               const LifeLevels& levels) {
  QuantityGroup group;
  for (const double percent : levels.percents) {
    group.requests.push_back(b_life_request(percent, levels, life, of));
  }
  group.from_draws = [levels, life](const WeightedDraws& draws) {
    std::vector<QuantityQuantiles> found;
    for (const double percent : levels.percents) {
      const double p = life.increasing ? percent / 100 : 1 - percent / 100;
      const double z = quantile(StandardDistribution::normal, p);
      const QuantityDistribution known(draws, [&](const double* x) {
        const double spread = life.scatter ? std::exp(z * life.scatter(x)) : 1;
        return life.value(life.driver(x) * spread);
      });
      const double next =
          life.scatter ? life.value(ItemMixture(draws, life.driver, life.scatter).quantile(p))
                       : known.quantile(percent / 100);
      found.push_back(b_life(known, next, levels));
    }
    return found;
  };
  return group;
}

}  // namespace wearwell
