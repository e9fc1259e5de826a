#include "wearwell/cli/option_value.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"

namespace wearwell {

double checked_option(const std::string& option, double value, Allowed allowed) {
  if (!std::isfinite(value))
    throw InputError(fmt::format("{}: the value is no finite number in SI units", option));
  if (allowed == Allowed::positive && !(value > 0))
    throw InputError(fmt::format("{} must be positive", option));
  if (allowed == Allowed::not_negative && !(value >= 0))
    throw InputError(fmt::format("{} must not be negative", option));
  return value;
}

double option_value(const std::string& option, const std::string& text, std::string_view si,
                    Allowed allowed) {
  try {
    return checked_option(option, read_quantity(text, si).si(), allowed);
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw InputError(message.starts_with(option) ? fmt::format("{} (it is '{}')", message, text)
                                                 : fmt::format("{}: {}", option, message));
  }
}

CLI::Validator number_between(double least, double most) {
  const std::string range = fmt::format("[{:g} - {:g}]", least, most);
  return CLI::Validator(
      [=](std::string& text) {
        double value = NAN;
        const bool read = CLI::detail::lexical_cast(text, value);
        return read && value >= least && value <= most
                   ? std::string()
                   : fmt::format("{} is no number in the range {}", text, range);
      },
      range, "number");
}

CLI::Validator seed_number() {
  return CLI::Validator(
      [](std::string& text) {
        std::uint64_t seed = 0;
        const char* end = text.data() + text.size();
        const auto [rest, failure] = std::from_chars(text.data(), end, seed);
        return failure == std::errc{} && rest == end
                   ? std::string()
                   : fmt::format("{} is no whole number from 0 to {}", text,
                                 std::numeric_limits<std::uint64_t>::max());
      },
      "", "seed");
}

}  // namespace wearwell
