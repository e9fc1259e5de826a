#pragma once

#include <string>

namespace wearwell::fatigue {

/// The damage sum at which an item fails: lognormal with this median, two thirds within a factor of
/// it; a factor of 1 is a known sum.
struct DamageSum {
  double median = 1;
  double factor = 1;

  bool is_one() const { return median == 1 && factor == 1; }
};

/// "0.7", or "0.7 x/ 1.5". Throws InputError that begins with `name`, an option or a key.
DamageSum read_damage_sum(const std::string& name, const std::string& text);

}  // namespace wearwell::fatigue
