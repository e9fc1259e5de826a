#include "wearwell/input/option_value.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"

namespace wearwell {

double checked_option(const std::string& option, const std::string& text, double value,
                      Allowed allowed) {
  const char* reason = !std::isfinite(value)                           ? "is not finite in SI units"
                       : allowed == Allowed::positive && !(value > 0)  ? "must be positive"
                       : allowed == Allowed::not_negative && value < 0 ? "must not be negative"
                                                                       : nullptr;
  if (reason) throw InputError(fmt::format("{}: '{}' {}", option, text, reason));
  return value;
}

double option_value(const std::string& option, const std::string& text, std::string_view si,
                    Allowed allowed) {
  double value = 0;
  try {
    value = read_quantity(text, si).si();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", option, error.what()));
  }
  return checked_option(option, text, value, allowed);
}

}  // namespace wearwell
