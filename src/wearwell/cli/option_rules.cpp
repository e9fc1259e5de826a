#include "wearwell/cli/option_rules.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "wearwell/base/nearest.h"

namespace wearwell {

CLI::Validator number_between(double least, double most) {
  const std::string range = fmt::format("[{:g} - {:g}]", least, most);
  return CLI::Validator(
      [=](std::string& text) {
        double value = NAN;
        const bool read = CLI::detail::lexical_cast(text, value);
        return read && value >= least && value <= most
                   ? std::string()
                   : fmt::format("'{}' must be {} and at most {:g}", text,
                                 least > 0 ? "positive" : "0 or more", most);
      },
      range, "number");
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  return CLI::Validator(
      [words](std::string& text) {
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        return fmt::format("'{}' is not allowed; use one of {}{}", text, fmt::join(words, ", "),
                           did_you_mean(text, words));
      },
      fmt::format("{}", fmt::join(words, "|")), "one of");
}

CLI::Validator seed_number() {
  return CLI::Validator(
      [](std::string& text) {
        std::uint64_t seed = 0;
        const char* end = text.data() + text.size();
        const auto [rest, failure] = std::from_chars(text.data(), end, seed);
        return failure == std::errc{} && rest == end
                   ? std::string()
                   : fmt::format("{} is not a whole number from 0 to {}", text,
                                 std::numeric_limits<std::uint64_t>::max());
      },
      "", "seed");
}

}  // namespace wearwell
