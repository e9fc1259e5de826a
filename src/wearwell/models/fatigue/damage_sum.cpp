#include "wearwell/models/fatigue/damage_sum.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/input/option_value.h"

namespace wearwell::fatigue {

DamageSum read_damage_sum(const std::string& name, const std::string& text) {
  const std::size_t at = text.find("x/");
  DamageSum sum{option_value(name, text.substr(0, at), "1", Allowed::positive), 1};
  if (at == std::string::npos) return sum;
  sum.factor = option_value(name, text.substr(at + 2), "1", Allowed::positive);
  if (sum.factor < 1)
    throw InputError(
        fmt::format("{}: the factor {} must be at least 1: two thirds lie between the median "
                    "divided by the factor and the median times the factor",
                    name, sum.factor));
  return sum;
}

}  // namespace wearwell::fatigue
