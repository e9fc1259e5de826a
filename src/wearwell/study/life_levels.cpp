#include "wearwell/study/life_levels.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/predict/item_mixture.h"
#include "wearwell/prob/standard_distribution.h"

namespace wearwell {

// "one" and "two" are words of predict.classical.
std::optional<BoundSides> sides_named(const std::string& text) {
  if (text == "lower" || text == "one") return BoundSides::lower;
  if (text == "upper") return BoundSides::upper;
  if (text == "both" || text == "two") return BoundSides::both;
  return {};
}

namespace {

std::optional<BoundSides> read_sides(const TomlReader& predict) {
  const auto text = predict.text("sides");
  if (!text) return {};
  const auto sides = sides_named(*text);
  if (!sides) predict.fail("sides", sides_refusal);
  return sides;
}

std::optional<double> read_level(const TomlReader& predict, const char* key) {
  const auto level = predict.quantity(key, "1");
  if (!level) return {};
  if (!(level->si() > 0 && level->si() < 1))
    predict.fail(key, "must lie between 0 and 1 (or 0 % and 100 %)");
  return level->si();
}

}  // namespace

double LifeLevels::below() const {
  return sides == BoundSides::both ? 0.5 * (1 - credible_level) : 1 - credible_level;
}

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
  const auto level = read_level(predict, "level"), credible = read_level(predict, "credible_level");
  if (level && credible)
    predict.fail("level", "and credible_level are the same; write one of the two");
  levels.credible_level = level.value_or(credible.value_or(levels.credible_level));
  const auto sides = read_sides(predict);
  if (sides) levels.sides = *sides;
  if ((level || credible || sides) && levels.percents.empty()) levels.percents = {1, 10};
  return levels;
}

StudyKeys level_keys(const std::string& of) {
  return {
      {"predict.level", "0.9", "confidence (credible level) of the bounds of " + of},
      {"predict.credible_level", "0.9", "as predict.level; write one of the two"},
      {"predict.sides", "\"both\"",
       "which bounds at this level: \"lower\" (the default), \"upper\", or \"both\" ends of the "
       "interval"}};
}

void ask_bounds(const LifeLevels& levels, QuantityRequest& request) {
  request.credible_level = levels.credible_level;
  request.sides = levels.sides;
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
  ask_bounds(levels, request);
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
