#include "wearwell/plan/life_requirement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_hint.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/option_value.h"
#include "wearwell/prognosis/quantity_like.h"

namespace wearwell::plan {
namespace {

std::string without_blanks_around(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  std::size_t first = 0;
  while (first < text.size() && std::isspace(static_cast<unsigned char>(text[first]))) ++first;
  return text.substr(first);
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

[[noreturn]] void refuse_point(const std::string& option, const std::string& text,
                               std::string_view relation, const std::string& reason) {
  throw InputError(
      fmt::format("{}: '{}' {}; write 'B10 {} 1e6 cycles' or 'reliability {} 90 % at 1e6 cycles'",
                  option, printable(text), reason, relation, relation));
}

// "B10" or "L10", a percentage that fails; 0 if it is neither.
double percent_of(const std::string& word) {
  if (word.size() < 2 || (word[0] != 'b' && word[0] != 'l')) return 0;
  double percent = 0;
  const char* end = word.data() + word.size();
  const auto [at, error] = std::from_chars(word.data() + 1, end, percent);
  return error == std::errc() && at == end ? percent : 0;
}

}  // namespace

Quantity read_any_quantity(const std::string& option, const std::string& text) {
  const std::string all = without_blanks_around(text);
  double number = 0;
  const auto [at, error] = std::from_chars(all.data(), all.data() + all.size(), number);
  const std::string unit =
      error == std::errc()
          ? without_blanks_around(all.substr(static_cast<std::size_t>(at - all.data())))
          : "";
  const bool known = !unit.empty() && parse_unit(unit).has_value();
  if (!unit.empty() && !known)
    throw InputError(fmt::format("{}: '{}': '{}' is not a unit{}", option, printable(text),
                                 printable(unit), unit_hint(unit, std::nullopt)));
  Quantity quantity;
  try {
    quantity = read_quantity(all, known ? unit : "1");
  } catch (const InputError& problem) {
    throw InputError(fmt::format("{}: {}", option, problem.what()));
  }
  return quantity;
}

double read_probability(const std::string& option, const std::string& text) {
  const double value = option_value(option, text, "1");
  if (!(value > 0 && value < 1))
    throw InputError(fmt::format("{}: '{}' must lie above 0 % and below 100 %, like '90 %'", option,
                                 printable(text)));
  return value;
}

LifePoint read_life_point(const std::string& option, const std::string& text,
                          std::string_view relation, const Unit* like) {
  std::string plain = text;
  if (const std::size_t sign = plain.find("≥"); sign != std::string::npos)
    plain.replace(sign, std::string("≥").size(), ">=");
  const std::size_t sign = plain.find_first_of("<>=");
  if (sign == std::string::npos) refuse_point(option, text, relation, "states no goal");
  const std::size_t after = plain.find_first_not_of("<>=", sign);
  if (plain.substr(sign, after - sign) != relation || after == std::string::npos)
    refuse_point(option, text, relation, fmt::format("must have '{}'", relation));
  const std::string name = lower_case(without_blanks_around(plain.substr(0, sign)));
  std::string value = without_blanks_around(plain.substr(after));
  LifePoint point{without_blanks_around(plain), 0, 0, {}};
  if (name == "reliability" || name == "r") {
    const std::size_t at = value.find(" at ");
    if (at == std::string::npos) refuse_point(option, text, relation, "does not say at which life");
    point.failing = 1 - read_probability(option, without_blanks_around(value.substr(0, at)));
    value = without_blanks_around(value.substr(at + 4));
  } else if (const double percent = percent_of(name); percent > 0) {
    if (!(percent < 100))
      refuse_point(option, text, relation, "must be of a share that fails below 100 %");
    point.failing = percent / 100;
  } else {
    refuse_point(option, text, relation, fmt::format("has an unknown goal '{}'", printable(name)));
  }
  if (like) prognosis::quantity_like(option, value, *like);
  const Quantity life = read_any_quantity(option, value);
  point.life = checked_option(option, value, life.si(), Allowed::positive);
  point.unit = life.unit;
  if (const auto unit = parse_unit(life.unit.text); unit && unit->offset != 0)
    refuse_point(option, text, relation, "is not a life");
  return point;
}

}  // namespace wearwell::plan
