#include "wearwell/input/median_factor.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/input/option_value.h"

namespace wearwell {

MedianFactor read_median_factor(const std::string& name, const std::string& text) {
  const std::size_t at = text.find("x/");
  MedianFactor value{option_value(name, text.substr(0, at), "1", Allowed::positive), 1};
  if (at == std::string::npos) return value;
  value.factor = option_value(name, text.substr(at + 2), "1", Allowed::positive);
  if (value.factor < 1)
    throw InputError(
        fmt::format("{}: the factor {} must be at least 1: two thirds lie between the median "
                    "divided by the factor and the median times the factor",
                    name, value.factor));
  return value;
}

}  // namespace wearwell
