#include "wearwell/prognosis/life_bounds.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/option_value.h"

namespace wearwell::prognosis {

LifeBounds read_life_bounds(const std::string& level, const std::string& sides) {
  LifeBounds bounds{!level.empty() || !sides.empty(), {}};
  if (!level.empty()) {
    const double share = option_value("--level", level, "1", Allowed::positive);
    if (!(share < 1))
      throw InputError(fmt::format("--level: {} must lie between 0 and 100 %", printable(level)));
    bounds.levels.credible_level = std::round(share * 1e12) / 1e12;  // 0.95 of 95 %
  }
  if (sides.empty()) return bounds;
  const auto known = sides_named(sides);
  if (!known) throw InputError(fmt::format("--sides: '{}' {}", printable(sides), sides_refusal));
  bounds.levels.sides = *known;
  return bounds;
}

std::string bound_text(const UnitLife& life, const LifeLevels& levels,
                       const std::function<std::string(double)>& shown) {
  const std::string lower = shown(life.quantile(levels.below())),
                    upper = shown(life.quantile(1 - levels.below()));
  const std::string value = levels.sides == BoundSides::both    ? lower + " to " + upper
                            : levels.sides == BoundSides::lower ? "at least " + lower
                                                                : "at most " + upper;
  return fmt::format("{} with probability {:.6g} %", value, 100 * levels.credible_level);
}

nlohmann::ordered_json bounds_json(const UnitLife& life, const LifeBounds& bounds) {
  nlohmann::ordered_json json = {{"level", bounds.levels.credible_level}};
  if (has_lower(bounds.levels.sides)) json["lower"] = life.quantile(bounds.levels.below());
  if (has_upper(bounds.levels.sides)) json["upper"] = life.quantile(1 - bounds.levels.below());
  return json;
}

}  // namespace wearwell::prognosis
