#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/life_levels.h"

namespace wearwell::prognosis {

/// Bounds of the life of one unit that `wearwell life` is asked for, beside its 90 % interval.
struct LifeBounds {
  bool asked = false;
  LifeLevels levels;
};

/// The options --level ("95 %") and --sides; either may be empty. Throws InputError that names the option.
LifeBounds read_life_bounds(const std::string& level, const std::string& sides);

/// "at least 530 h with probability 95 %"; `shown` writes a life.
std::string bound_text(const UnitLife& life, const LifeLevels& levels,
                       const std::function<std::string(double)>& shown);

/// level, lower, upper; the bounds that were asked for.
nlohmann::ordered_json bounds_json(const UnitLife& life, const LifeBounds& bounds);

}  // namespace wearwell::prognosis
