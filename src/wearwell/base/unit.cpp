#include "wearwell/base/unit.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/erase.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/unit_hint.h"
#include "wearwell/base/unit_system.h"

// Longer than others: all checks of a unit share one parsed text.
namespace wearwell {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

std::string_view example(std::string_view si) {
  return si == "K" ? "K' or 'degC" : si;
}

int power(const Dimension& dimension, const char* base) {
  const auto found = dimension.find(base);
  return found == dimension.end() ? 0 : found->second;
}

Dimension without_turns(Dimension dimension) {
  dimension.erase("cycle");
  dimension.erase("radian");
  return dimension;
}

// The power of the rotational speed in such an SI unit, else 0.
int rotation_power(std::string_view si) {
  if (si == "rev/s" || si == "rad/s") return 1;
  return si == "m^3 s/(J rad)" ? -1 : 0;
}

[[noreturn]] void refuse_bare_speed(std::string_view written, double value, double per_second) {
  const double s = value * per_second;
  throw InputError(fmt::format(
      "'{}{}' counts neither revolutions nor radians: it is {:.4g} rev/s = {:.4g} "
      "rad/s, or {:.4g} rad/s = {:.4g} rev/s; write rev/s (rpm, Hz) or rad/s",
      value == 1 ? "" : fmt::format("{:.6g} ", value), written, s, two_pi * s, s, s / two_pi));
}

// The factor between revolutions and radians of a rotational speed; 0 for another dimension.
double rotation_factor(const ParsedUnit& unit, const Dimension& wanted, int rotations,
                       std::string_view written, double value) {
  const int cycles = power(unit.dimension, "cycle"), radians = power(unit.dimension, "radian");
  if (without_turns(unit.dimension) != without_turns(wanted)) return 0;
  bool in_turns = cycles == rotations && radians == 0;
  const bool in_radians = cycles == 0 && radians == rotations;
  if (cycles == 0 && radians == 0) {
    constexpr double per_minute = 1.0 / 60;
    if (rotations != 1) {
      throw InputError(
          fmt::format("'{}' counts neither revolutions nor radians, which differ by a factor of 2 "
                      "pi; write rev or rad in the unit",
                      written));
    }
    if (std::abs(unit.scale - per_minute) > 1e-12 * per_minute)
      refuse_bare_speed(written, value, unit.scale);
    in_turns = true;
  }
  if (in_turns == in_radians) return 0;
  const bool wants_turns = power(wanted, "cycle") != 0;
  if (in_turns == wants_turns) return 1;
  return std::pow(two_pi, in_turns ? rotations : -rotations);
}

[[noreturn]] void refuse_dimension(const Dimension& dimension, const Dimension& wanted,
                                   std::string_view written, std::string_view si) {
  Dimension reciprocal = dimension;
  for (auto& [base, exponent] : reciprocal) exponent = -exponent;
  const char* fault = "has the wrong dimension";
  if (!dimension.empty() && without_turns(reciprocal) == without_turns(wanted) &&
      without_turns(dimension) != without_turns(wanted)) {
    fault = "is the reciprocal of the expected unit";
  } else if (without_turns(dimension) == without_turns(wanted)) {
    fault = power(dimension, "radian") != power(wanted, "radian")
                ? "contains an angle, which is neither a count nor a pure number"
                : "contains a count of cycles or revolutions, which does not fit here";
  }
  // "mm^3/N m" is (mm^3/N) m.
  std::string hint;
  if (const auto slash = written.find('/'); slash != written.npos) {
    hint = fmt::format("{}/({})", written.substr(0, slash), written.substr(slash + 1));
    const auto hinted = parse_unit(hint);
    hint = hinted && hinted->dimension == wanted ? fmt::format("; did you mean '{}'?", hint) : "";
  }
  if (hint.empty()) hint = unit_hint(std::string(written), wanted);
  throw InputError(
      fmt::format("unit '{}' {} (expected one like '{}'{})", written, fault, example(si), hint));
}

// "mm 3": UDUNITS-2 multiplies by a number after the unit.
void refuse_number_behind(const std::string& written) {
  for (std::size_t i = 1; i < written.size(); ++i) {
    const auto is = [&](int (*kind)(int), std::size_t at) {
      return kind(static_cast<unsigned char>(written[at])) != 0;
    };
    if (!is(std::isdigit, i) || !is(std::isspace, i - 1)) continue;
    std::size_t before = i - 1;
    while (before > 0 && is(std::isspace, before)) --before;
    if (!is(std::isalnum, before) && written[before] != ')') continue;
    throw InputError(
        fmt::format("'{}': the number after the space can be a factor or a power; write a factor "
                    "before the unit, or a power with ^",
                    written));
  }
}

// "m^0.5": UDUNITS-2 reads m^0 times .5.
void refuse_broken_power(const std::string& written) {
  const auto is_digit = [&](std::size_t at) {
    return at < written.size() && std::isdigit(static_cast<unsigned char>(written[at])) != 0;
  };
  for (std::size_t i = 0; i < written.size(); ++i) {
    if (written[i] != '^' && written.compare(i, 2, "**") != 0) continue;
    std::size_t at = i + (written[i] == '^' ? 1 : 2);
    if (at < written.size() && (written[at] == '-' || written[at] == '+')) ++at;
    while (is_digit(at)) ++at;
    if (at + 1 < written.size() &&
        std::string_view(".,/").find(written[at]) != std::string_view::npos && is_digit(at + 1))
      throw InputError(fmt::format("'{}': the power of a unit must be a whole number", written));
  }
}

bool starts_with_number(std::string_view text) {
  const std::size_t sign = !text.empty() && std::string_view("+-.,").find(text[0]) != text.npos;
  return text.size() > sign && std::isdigit(static_cast<unsigned char>(text[sign]));
}

Unit read_linear(const std::string& written, std::string_view si, double value) {
  const auto wanted = parse_unit(std::string(si));
  if (!wanted) throw std::logic_error(fmt::format("'{}' is not an SI unit", si));
  const auto unit = parse_unit(written);
  if (!unit) {
    const std::string sizes = two_sizes(written);
    throw InputError(sizes.empty()
                         ? fmt::format("'{}' is not a unit (expected one like '{}'{})", written,
                                       example(si), unit_hint(written, wanted->dimension))
                         : fmt::format("'{}' has two sizes: {}", written, sizes));
  }
  if (!unit->linear) {
    throw InputError(
        fmt::format("'{}' is a logarithm or a point in time, not a unit (expected one like '{}')",
                    written, si));
  }
  refuse_number_behind(written);
  refuse_broken_power(written);
  if (!std::isnormal(unit->scale) || unit->scale < 0 || !std::isfinite(unit->offset)) {
    throw InputError(
        fmt::format("'{}' is {} in '{}'; a unit must be positive", written, unit->scale, si));
  }
  double factor = 1;
  if (const int rotations = rotation_power(si); rotations != 0) {
    factor = rotation_factor(*unit, wanted->dimension, rotations, written, value);
  } else if (unit->dimension != wanted->dimension) {
    Dimension counted = unit->dimension;  // a count may be omitted
    const int cycles = power(wanted->dimension, "cycle");
    if (cycles != 0) counted.emplace("cycle", cycles);
    factor = counted == wanted->dimension ? 1 : 0;
  }
  if (factor == 0) refuse_dimension(unit->dimension, wanted->dimension, written, si);
  const bool temperature = wanted->dimension == Dimension{{"kelvin", 1}};
  if (temperature ? starts_with_number(written) : unit->offset != 0) {
    throw InputError(
        fmt::format("'{}': its zero point is unknown (expected one like '{}')", written, si));
  }
  // "zdegF": rounding would destroy such values.
  constexpr double least = 1e-9;  // relative to the distance of the zero points: leaves seven
                                  // digits of one unit
  if (unit->scale < least * std::abs(unit->offset)) {
    throw InputError(
        fmt::format("'{}' is {:.3g} {}, too small compared with its zero point at {:.6g}", written,
                    unit->scale, si, unit->offset));
  }
  if (wanted->dimension == Dimension{{"cycle", 1}} && unit->scale < 0.5) {
    throw InputError(
        fmt::format("'{}' is {:.6g} of one, but a count has no fractions; write M for a million, "
                    "as in 'Mcycles'",
                    written, unit->scale));
  }
  return Unit{written, unit->scale * factor, unit->offset};
}

Unit read_unit(std::string_view text, std::string_view si, double value) {
  const std::string written = boost::algorithm::trim_copy(std::string(text));
  if (!is_logarithm(si)) {
    // The unit itself needs no check and need not be an SI unit.
    const auto same = written == si ? parse_unit(written) : std::nullopt;
    return same && same->linear ? Unit{written, same->scale, same->offset}
                                : read_linear(written, si, value);
  }
  if (!is_logarithm(written)) {
    throw InputError(
        fmt::format("'{}' is not the logarithm of a quantity (write one like '{}')", written, si));
  }
  const auto inner = [](std::string_view log) { return log.substr(6, log.size() - 7); };
  const Unit unit = read_unit(inner(written), inner(si), 1);
  if (unit.offset != 0)
    throw InputError(
        fmt::format("'{}': the unit has an offset, so its logarithm is undefined", written));
  return Unit{written, 1, std::log10(unit.scale)};
}

// "0,1 mm", "1.234,5 mm", "1,234.5 mm" and "12'000 cycles": a C number ends before the mark.
void refuse_marks(const std::string& written) {
  const std::size_t sign = written.starts_with('-') || written.starts_with('+');
  const std::size_t end =
      std::min(written.find_first_not_of("0123456789.,'", sign), written.size());
  const std::string number = written.substr(0, end);
  const bool marked =
      number.find_first_of(",'") != number.npos || number.find('.') != number.find_last_of('.');
  if (!marked || !starts_with_number(number)) return;
  const std::size_t last = number.find_last_of(".,");
  const bool one_kind = number.find('.') == number.npos && number.find('\'') == number.npos;
  const auto behind = static_cast<long>(end - last) - 1;
  if (one_kind && last == number.find(',')) {
    if (behind == 0) return;
    const std::size_t before = last - sign;
    if (behind == 3 && before <= 3 && number[sign] != '0') {
      throw InputError(
          fmt::format("'{}' is ambiguous: {} with a decimal comma, {} with a thousands separator; "
                      "use a decimal point and no separators",
                      written, boost::algorithm::replace_first_copy(number, ",", "."),
                      boost::algorithm::erase_all_copy(number, ",")));
    }
  }
  if (number.find_first_of(",'") == number.npos) {  // only points: "1.5.2" is not a number
    for (std::size_t at = number.find('.'); at != number.npos; at = number.find('.', at + 1)) {
      if (std::min(number.find('.', at + 1), end) != at + 4) return;
    }
  }
  // A mark that occurs twice is a thousands separator; of two kinds of mark the last is the decimal
  // mark.
  const bool repeated = last == number.npos || number.find(number[last]) != last;
  std::string plain;
  for (std::size_t i = 0; i < end; ++i) {
    if (i == last && !repeated)
      plain += '.';
    else if (number[i] != ',' && number[i] != '.' && number[i] != '\'')
      plain += number[i];
  }
  const bool comma = last != number.npos && number[last] == ',' && !repeated;
  throw InputError(fmt::format("'{}' has {}; write '{}'", written,
                               comma ? "a decimal comma; use a decimal point"
                                     : "thousands separators, which are not allowed",
                               plain + written.substr(end)));
}

// "2 x 10^-6 mm^3/Nm" is 2e-6.
void refuse_power_of_ten(const std::string& written, std::string_view unit) {
  for (const std::string_view times : {"\u00d7", "*", "x", "X", "\u00b7", "\u22c5"}) {
    if (!unit.starts_with(times)) continue;
    unit.remove_prefix(times.size());
    break;
  }
  while (unit.starts_with(' ')) unit.remove_prefix(1);
  const bool power = unit.starts_with("10^") || unit.starts_with("10-") ||
                     unit.starts_with("10\u207b") || unit.starts_with("10**");
  if (power)
    throw InputError(
        fmt::format("'{}': write a power of ten with e, for example 2e-6 for 2 x 10^-6", written));
}

// "35 200 cycles" is 35 times 200 cycles to UDUNITS-2. "60 1/min" is fine.
void refuse_gap(const std::string& written, double value, const std::string& unit) {
  if (!starts_with_number(unit)) return;
  const std::size_t behind = unit.find_first_not_of("0123456789");
  const std::size_t slash = unit.find_first_not_of(' ', std::min(behind, unit.size()));
  if (unit.starts_with("1") && behind == 1 && slash != unit.npos && unit[slash] == '/') return;
  double factor = 0;
  std::from_chars(unit.data(), unit.data() + unit.size(), factor);
  throw InputError(
      fmt::format("'{}' is ambiguous: one number with a gap, or {:.6g} times {:.6g}, which is "
                  "{:.6g}; write the number without a gap",
                  written, value, factor, value * factor));
}

}  // namespace

Unit read_unit(std::string_view text, std::string_view si) {
  return read_unit(text, si, 1);
}

bool may_be_plain(std::string_view si) {
  if (is_logarithm(si)) return false;
  const auto unit = parse_unit(std::string(si));
  return unit && (unit->dimension.empty() || unit->dimension == Dimension{{"cycle", 1}});
}

bool is_number(const Unit& unit) {
  if (is_logarithm(unit.text)) return false;
  const auto parsed = parse_unit(unit.text);
  return parsed && parsed->dimension.empty();
}

Quantity read_quantity(std::string_view text, std::string_view si) {
  const std::string written = boost::algorithm::trim_copy(std::string(text));
  refuse_marks(written);
  double value = 0;
  const char* end = written.data() + written.size();
  const auto [rest, failure] = std::from_chars(written.data(), end, value);
  if (failure != std::errc{} || !std::isfinite(value)) {
    throw InputError(
        si == "1" ? fmt::format("'{}' is not a number", written)
                  : fmt::format("'{}' is not a number with a unit (like '1.5 {}')", written, si));
  }
  const std::string unit = boost::algorithm::trim_copy(std::string(rest, end));
  if (unit.empty() && !may_be_plain(si)) {
    throw InputError(
        fmt::format("'{}' has no unit (write one like '{} {}')", written, written, si));
  }
  if (unit.empty()) return Quantity{value, Unit{"1", 1, 0}};
  refuse_power_of_ten(written, unit);
  refuse_gap(written, value, unit);
  const Quantity quantity{value, read_unit(unit, si, value)};
  if (!std::isfinite(quantity.si())) throw InputError(fmt::format("'{}' is infinite", written));
  if (si == "K" && quantity.si() < 0)
    throw InputError(fmt::format("'{}' is below absolute zero", written));
  return quantity;
}

void refuse_two_readings(const Quantity& quantity, const Unit& beside) {
  if (quantity.unit.text != "1" || quantity.value == 0 || beside.scale == 1) return;
  throw InputError(fmt::format(
      "{} is given beside '{}' and is ambiguous: {}, or {} '{}' = {:.6g}; write its unit",
      quantity.value, beside.text, quantity.value, quantity.value, beside.text,
      quantity.value * beside.scale));
}

}  // namespace wearwell
