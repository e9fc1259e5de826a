#include "wearwell/present/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace wearwell {
namespace {

constexpr const char *narrow_space = "\u202f", *hard_space = "\u00a0";
constexpr int least_exponent = -3, most_exponent = 6;  // range without a power of ten
constexpr int given_digits = 9;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string raised(const std::string& digits) {
  static constexpr const char* shapes[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  for (const char c : digits) {
    if (c == '-') out += "⁻";
    if (is_digit(c)) out += shapes[c - '0'];
  }
  return out;
}

std::string power_of_ten(int exponent, Script script) {
  const std::string digits = std::to_string(exponent);
  return "10" + (script == Script::page ? raised(digits) : "^" + digits);
}

std::string times_power(int exponent, Script script) {
  return exponent == 0 ? "" : fmt::format("{0}×{0}{1}", hard_space, power_of_ten(exponent, script));
}

int decade_of(double x) {
  return x == 0 || !std::isfinite(x) ? 0 : static_cast<int>(std::floor(std::log10(std::abs(x))));
}

// The power of ten with which the number is written, if any.
int exponent_of(double x) {
  const int exponent = decade_of(x);
  return exponent < least_exponent || exponent > most_exponent ? exponent : 0;
}

// In two steps, because the power underflows or overflows at the limits of a double.
double mantissa(double x, int exponent) {
  return x / std::pow(10.0, exponent / 2) / std::pow(10.0, exponent - exponent / 2);
}

// Groups thousands; uses a typographic minus on a page.
std::string spaced(std::string text, Script script) {
  std::string sign;
  if (text.front() == '-') {
    text.erase(0, 1);
    sign = script == Script::page ? "−" : "-";
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  for (std::size_t at = point; at > 3;) text.insert(at -= 3, narrow_space);
  return sign + text;
}

// 9.9996 to four digits is 10.00, not 10.000.
double rounded(double x, int digits) {
  const double near = std::strtod(fmt::format("{:.{}e}", x, digits - 1).c_str(), nullptr);
  return std::isfinite(near) ? near : x;  // the largest doubles overflow
}

std::string plain(double x, int digits, Script script) {
  if (x == 0) return "0";
  x = rounded(x, digits);
  const int whole = static_cast<int>(std::floor(std::log10(std::abs(x)))) + 1;
  if (whole < digits) return spaced(fmt::format("{:.{}f}", x, digits - whole), script);
  const double step = std::pow(10.0, whole - digits);
  return spaced(fmt::format("{:.0f}", std::round(x / step) * step), script);
}

// "3.500 × 10^5", also of a number that would be written without a power: "5.000 × 10^0".
std::string with_power(double x, int digits, Script script) {
  const int exponent = decade_of(x);
  return fmt::format("{0}{1}×{1}{2}", plain(mantissa(x, exponent), digits, script), hard_space,
                     power_of_ten(exponent, script));
}

std::string not_finite(double x, Script script) {
  if (script == Script::page) return "–";
  return std::isnan(x) ? "-" : x > 0 ? "inf" : "-inf";
}

// The end of a number in a text, in fmt's format: "12.5", "1e+06".
struct Token {
  std::size_t end = 0;
  bool has_power = false, is_whole = true;
};
Token token_at(const std::string& text, std::size_t begin) {
  Token token{begin};
  const auto skip_digits = [&] {
    while (token.end < text.size() && is_digit(text[token.end])) ++token.end;
  };
  skip_digits();
  if (token.end + 1 < text.size() && text[token.end] == '.' && is_digit(text[token.end + 1])) {
    ++token.end;
    token.is_whole = false;
    skip_digits();
  }
  if (token.end + 2 < text.size() && text[token.end] == 'e' &&
      (text[token.end + 1] == '+' || text[token.end + 1] == '-') && is_digit(text[token.end + 2])) {
    token.end += 2;
    token.has_power = true;
    skip_digits();
  }
  return token;
}

bool belongs_to_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || (c & 0x80) != 0;
}

// A number in a formula, "/ 5e-05 [m^2]", is one operand and stays unchanged.
bool is_operand(const std::string& before) {
  const std::size_t last = before.find_last_not_of(' ');
  return last != before.npos &&
         std::string_view("*/^").find(before[last]) != std::string_view::npos;
}

std::string in_text(const std::string& text, Script script, bool thousands) {
  constexpr std::size_t most_together = 4;
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const bool inside = i > 0 && (belongs_to_word(text[i - 1]) || text[i - 1] == '.');
    if (!is_digit(text[i]) || inside) {
      out += text[i++];
      continue;
    }
    const Token token = token_at(text, i);
    const std::string digits = text.substr(i, token.end - i);
    const bool cut_off =
        token.end < text.size() && (belongs_to_word(text[token.end]) || text[token.end] == '^');
    const bool long_one = thousands && token.is_whole && digits.size() > most_together &&
                          digits.size() <= given_digits && digits.front() != '0';
    const bool changes = !cut_off && !is_operand(out) && (token.has_power || long_one);
    out += changes ? given_text(std::strtod(digits.c_str(), nullptr), script) : digits;
    i = token.end;
  }
  return out;
}

}  // namespace

std::string shown_number(double x, int digits, Script script) {
  if (!std::isfinite(x)) return not_finite(x, script);
  x = rounded(x, digits);
  const int exponent = exponent_of(x);
  return plain(mantissa(x, exponent), digits, script) + times_power(exponent, script);
}

std::string given_text(double x, Script script) {
  if (!std::isfinite(x)) return not_finite(x, script);
  const int exponent = exponent_of(x);
  const std::string digits = fmt::format("{:.{}g}", mantissa(x, exponent), given_digits);
  if (exponent != 0 && digits == "1") return power_of_ten(exponent, script);
  return spaced(digits, script) + times_power(exponent, script);
}

int digits_within(double relative_error, int most) {
  if (!(relative_error > 0)) return most;
  return std::clamp(static_cast<int>(std::floor(-std::log10(relative_error))) + 1, 2, most);
}

std::string fixed_text(double x, int decimals, Script script) {
  return std::isfinite(x) ? spaced(fmt::format("{:.{}f}", x, decimals), script)
                          : not_finite(x, script);
}

std::string range_text(double low, double high, int digits, Script script) {
  constexpr int least_kept = 3;  // digits of the smaller end under the power of the larger
  low = rounded(low, digits), high = rounded(high, digits);
  const bool finite = std::isfinite(low) && std::isfinite(high);
  const int apart = low == 0 || high == 0 ? 0 : std::abs(decade_of(high) - decade_of(low));
  const int shared = apart > 1 ? 0 : exponent_of(std::max(std::abs(low), std::abs(high)));
  if (finite && shared != 0) {
    const auto end = [&](double x) {
      const bool smaller = decade_of(x) < shared;
      return plain(mantissa(x, shared),
                   smaller ? std::max(digits - 1, std::min(digits, least_kept)) : digits, script);
    };
    return end(low) + " to " + end(high) + times_power(shared, script);
  }
  // The power of the upper end would seem to be that of both.
  const bool misread = finite && low != 0 && exponent_of(high) != 0;
  return (misread ? with_power(low, digits, script) : shown_number(low, digits, script)) + " to " +
         shown_number(high, digits, script);
}

namespace {

// "10⁶ cycles" of "1e6 cycles"; empty for a unit that is not a multiple.
std::string multiple_text(const std::string& unit, Script script) {
  const std::size_t digits = unit.find_first_not_of("0123456789", 2);
  if (!unit.starts_with("1e") || digits == unit.npos || digits == 2) return {};
  return power_of_ten(std::atoi(unit.substr(2, digits - 2).c_str()), script) +
         unit_description(unit.substr(digits), script);
}

}  // namespace

std::string unit_description(const std::string& unit, Script script) {
  if (unit == "1") return {};
  const std::string multiple = multiple_text(unit, script);
  if (!multiple.empty()) return fmt::format("×{}{}", hard_space, multiple);
  const std::size_t under = unit.find("/(");  // "1/(1e6 cycles)", "EUR/(1e6 cycles)"
  if (under != unit.npos && unit.ends_with(")")) {
    const std::string per = multiple_text(unit.substr(under + 2, unit.size() - under - 3), script);
    if (!per.empty()) return fmt::format("{}/({})", unit.substr(0, under), per);
  }
  std::string out;
  for (const char c : script == Script::page ? powers_raised(unit) : unit)
    out += c == ' ' ? std::string(hard_space) : std::string(1, c);
  return out;
}

std::string powers_raised(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '^') {
      out += text[i];
      continue;
    }
    const std::size_t end = std::min(text.find_first_not_of("-0123456789", i + 1), text.size());
    if (end == i + 1) {  // N^b stays unchanged
      out += '^';
      continue;
    }
    out += raised(text.substr(i + 1, end - i - 1));
    i = end - 1;
  }
  return out;
}

std::string powers_text(const std::string& text, Script script) {
  return in_text(text, script, false);
}

std::string numbers_text(const std::string& text, Script script) {
  return in_text(text, script, true);
}

}  // namespace wearwell
