#include "wearwell/plan/goal_target.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <regex>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"

namespace wearwell::plan {

double target_width(const std::string& text, const Unit& unit, bool logarithmic) {
  static const std::regex form(R"(^\s*width\s*<=?\s*(factor\s+)?([-+0-9.eE]+)\s*(.*?)\s*$)");
  std::smatch match;
  const std::string like =
      logarithmic ? "'width <= factor 1.5'"
                  : fmt::format("'width <= 20{}'", unit.text == "1" ? "" : " " + unit.text);
  if (!std::regex_match(text, match, form))
    throw InputError(fmt::format("--until: '{}' must be like {}", printable(text), like));
  const std::string digits = match[2], given_unit = match[3];
  double number = NAN;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool factor = match[1].matched;
  if (factor != logarithmic)
    throw InputError(fmt::format(
        "--until: '{}': the uncertainty of this goal is {}; write it like {}", printable(text),
        logarithmic ? "a factor, the upper end of its interval over the lower" : "a difference",
        like));
  if (!(number > (factor ? 1 : 0)) || !std::isfinite(number))
    throw InputError(
        fmt::format("--until: '{}': the width must be above {}", printable(text), factor ? 1 : 0));
  if (factor) {
    if (!given_unit.empty())
      throw InputError(fmt::format("--until: '{}': a factor has no unit", printable(text)));
    return std::log(number);
  }
  if (given_unit.empty() || given_unit == unit.text) {
    if (given_unit.empty() && unit.text != "1")
      throw InputError(fmt::format("--until: '{}' needs a unit, like {}", printable(text), like));
    return number;
  }
  const auto own = parse_unit(unit.text), given = parse_unit(given_unit);
  if (!own || !given || own->dimension != given->dimension || !given->linear)
    throw InputError(fmt::format("--until: '{}': '{}' is not a unit like {}", printable(text),
                                 printable(given_unit), unit.text));
  return number * given->scale / unit.scale;
}

}  // namespace wearwell::plan
