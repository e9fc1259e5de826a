#include "wearwell/models/fatigue/damage_sum.h"

#include "wearwell/input/median_factor.h"

namespace wearwell::fatigue {

DamageSum read_damage_sum(const std::string& name, const std::string& text) {
  const MedianFactor sum = read_median_factor(name, text);
  return {sum.median, sum.factor};
}

}  // namespace wearwell::fatigue
