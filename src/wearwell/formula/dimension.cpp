#include "wearwell/formula/dimension.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/trim.hpp>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <vector>

#include "wearwell/base/error.h"

namespace wearwell::formula {
namespace {

struct Base {
  const char* name;
  const char* symbol;
};
// The order of units in text.
constexpr std::array<Base, 9> bases = {{{"kilogram", "kg"},
                                        {"meter", "m"},
                                        {"ampere", "A"},
                                        {"mole", "mol"},
                                        {"candela", "cd"},
                                        {"cycle", "cycle"},
                                        {"radian", "rad"},
                                        {"kelvin", "K"},
                                        {"second", "s"}}};

struct Named {
  const char* symbol;
  Powers powers;
};

const std::vector<Named>& named_units() {
  static const std::vector<Named> units = {
      {"N", {{"kilogram", 1}, {"meter", 1}, {"second", -2}}},
      {"Pa", {{"kilogram", 1}, {"meter", -1}, {"second", -2}}},
      {"J", {{"kilogram", 1}, {"meter", 2}, {"second", -2}}},
      {"W", {{"kilogram", 1}, {"meter", 2}, {"second", -3}}},
      {"V", {{"kilogram", 1}, {"meter", 2}, {"second", -3}, {"ampere", -1}}},
      {"ohm", {{"kilogram", 1}, {"meter", 2}, {"second", -3}, {"ampere", -2}}}};
  return units;
}

Power size(const Power& power) {
  return power.numerator() < 0 ? -power : power;
}

double number(const Power& power) {
  return static_cast<double>(power.numerator()) / power.denominator();
}

// The number of symbols in their text.
double cost(const Powers& powers) {
  double sum = 0;
  for (const auto& [base, power] : powers) sum += std::abs(number(power));
  return sum;
}

std::string factor(std::string_view symbol, const Power& power) {
  if (power == 1) return std::string(symbol);
  if (power == Power(1, 2)) return fmt::format("sqrt({})", symbol);
  if (power.denominator() == 1) return fmt::format("{}^{}", symbol, power.numerator());
  return fmt::format("{}^({}/{})", symbol, power.numerator(), power.denominator());
}

struct Factor {
  std::string_view symbol;
  Power power;
};

std::string fraction(const std::vector<Factor>& factors) {
  std::string above, below;
  int divisors = 0;
  for (const Factor& each : factors) {
    std::string& side = each.power.numerator() > 0 ? above : below;
    divisors += each.power.numerator() < 0;
    side += (side.empty() ? "" : " ") + factor(each.symbol, size(each.power));
  }
  if (below.empty()) return above;
  if (divisors > 1) below = "(" + below + ")";
  return fmt::format("{}/{}", above.empty() ? "1" : above, below);
}

std::vector<Factor> factors_of(const Powers& powers) {
  std::vector<Factor> factors;
  for (const Base& base : bases) {
    if (const auto at = powers.find(base.name); at != powers.end())
      factors.push_back({base.symbol, at->second});
  }
  return factors;
}

void multiply(Powers& into, const Powers& by, const Power& sign) {
  for (const auto& [base, power] : by) {
    Power& sum = into[base];
    sum = sum + sign * power;
    if (sum == 0) into.erase(base);
  }
}

}  // namespace

Power::Power(int numerator, int denominator) {
  const int divisor = std::gcd(numerator, denominator) * (denominator < 0 ? -1 : 1);
  above_ = numerator / divisor;
  below_ = denominator / divisor;
}
Power operator+(const Power& a, const Power& b) {
  return {a.above_ * b.below_ + b.above_ * a.below_, a.below_ * b.below_};
}
Power operator*(const Power& a, const Power& b) {
  return {a.above_ * b.above_, a.below_ * b.below_};
}

Powers powers_of(const wearwell::Dimension& dimension) {
  Powers powers;
  for (const auto& [base, power] : dimension) powers[base] = power;
  return powers;
}

Powers product(const Powers& a, const Powers& b) {
  Powers result = a;
  multiply(result, b, 1);
  return result;
}

Powers quotient(const Powers& a, const Powers& b) {
  Powers result = a;
  multiply(result, b, -1);
  return result;
}

Powers raised(const Powers& a, Power exponent) {
  Powers result;
  if (exponent == 0) return result;
  for (const auto& [base, power] : a) result[base] = power * exponent;
  return result;
}

std::string description(const Powers& powers) {
  if (powers.empty()) return "a pure number";
  std::vector<Factor> best = factors_of(powers);
  double least = cost(powers);
  if (!powers.contains("kilogram")) return fraction(best);
  for (const Named& unit : named_units()) {
    for (const int sign : {1, -1, 2, -2}) {
      Powers rest = powers;
      multiply(rest, unit.powers, -sign);
      if (cost(rest) + std::abs(sign) >= least) continue;
      least = cost(rest) + std::abs(sign);
      best = factors_of(rest);
      best.insert(best.begin(), {unit.symbol, sign});
    }
  }
  return fraction(best);
}

std::string si_text(const Powers& powers) {
  if (powers == Powers{{"cycle", 1}, {"second", -1}}) return "rev/s";
  if (powers == Powers{{"radian", 1}, {"second", -1}}) return "rad/s";
  std::string text;
  for (const Base& base : bases) {
    const auto at = powers.find(base.name);
    if (at == powers.end()) continue;
    if (at->second.denominator() != 1)
      throw InputError(fmt::format("{} is not the dimension of any input", description(powers)));
    text += (text.empty() ? "" : " ") + factor(base.symbol, at->second);
  }
  return text.empty() ? "1" : text;
}

namespace {

// "m^0.5" and "m^(1/2)" as "sqrt(m)".
std::string with_roots(std::string text) {
  for (const std::string_view half : {"^0.5", "^(1/2)", "**0.5", "^.5"}) {
    for (std::size_t at; (at = text.find(half)) != text.npos;) {
      std::size_t start = at;
      while (start > 0 && (std::isalpha(static_cast<unsigned char>(text[start - 1])) != 0 ||
                           static_cast<unsigned char>(text[start - 1]) >= 0x80))
        --start;
      const bool longer = at + half.size() < text.size() &&
                          std::isdigit(static_cast<unsigned char>(text[at + half.size()])) != 0;
      if (start == at || longer) return text;
      text = fmt::format("{}sqrt({}){}", text.substr(0, start), text.substr(start, at - start),
                         text.substr(at + half.size()));
    }
  }
  return text;
}

AnyUnit plain_unit(const std::string& text) {
  // Checked here, because UDUNITS-2 reads m^0.3 as m^0 times 0.3.
  for (std::size_t at = 0; (at = text.find_first_of("^*", at)) != text.npos; ++at) {
    if (text[at] == '*' && text.substr(at, 2) != "**") continue;
    const std::size_t end = text.find_first_not_of("^*+-0123456789", at);
    if (end != text.npos && text[end] == '.' && end + 1 < text.size() &&
        std::isdigit(static_cast<unsigned char>(text[end + 1])) != 0)
      throw InputError(
          fmt::format("'{}': a power in a unit must be a whole number, or write sqrt(m)", text));
  }
  const auto parsed = parse_unit(text);
  if (!parsed && two_sizes(text).empty()) throw InputError(fmt::format("'{}' is not a unit", text));
  const Powers powers = parsed ? powers_of(parsed->dimension) : Powers{};
  return {read_unit(text, si_text(powers)), powers};
}

struct Root {
  std::string rest, inner;
  bool below = false;  ///< after a slash
};

// A square root as a separate factor, outside brackets.
std::optional<Root> split_root(const std::string& text) {
  const std::size_t at = text.find("sqrt(");
  if (at == text.npos) return {};
  const std::size_t end = text.find(')', at);
  if (end == text.npos || text.substr(0, at).find('(') != text.npos) return {};
  Root root;
  root.inner = text.substr(at + 5, end - at - 5);
  std::string before = text.substr(0, at);
  boost::algorithm::trim_right(before);
  if (!before.empty() && before.back() == '/') root.below = true;
  while (!before.empty() && (before.back() == '/' || before.back() == '*' || before.back() == '.' ||
                             before.back() == ' '))
    before.pop_back();
  std::string behind = text.substr(end + 1);
  boost::algorithm::trim_left(behind);
  if (before.empty()) before = "1";
  if (behind.starts_with('*') || behind.starts_with('.')) behind.erase(0, 1);
  root.rest = behind.starts_with('/') || behind.empty() ? before + behind : before + " " + behind;
  return root;
}

}  // namespace

AnyUnit read_any_unit(std::string_view text) {
  const std::string written = boost::algorithm::trim_copy(std::string(text));
  const auto root = split_root(with_roots(written));
  if (!root) return plain_unit(written);
  const AnyUnit rest = plain_unit(root->rest), inner = plain_unit(root->inner);
  if (rest.unit.offset != 0 || inner.unit.offset != 0)
    throw InputError(fmt::format("'{}': its zero point is unknown", written));
  const double size = std::sqrt(inner.unit.scale);
  const Powers powers = raised(inner.powers, Power(1, 2));
  return {{written, root->below ? rest.unit.scale / size : rest.unit.scale * size, 0},
          root->below ? quotient(rest.powers, powers) : product(rest.powers, powers)};
}

AnyQuantity read_any_quantity(std::string_view text) {
  const std::string written = boost::algorithm::trim_copy(std::string(text));
  double value = 0;
  const char* end = written.data() + written.size();
  const auto [rest, failure] = std::from_chars(written.data(), end, value);
  if (failure != std::errc{} || !std::isfinite(value)) {
    throw InputError(
        fmt::format("'{}' is not a number with a unit (like '1.5 mm^3/(N m)')", written));
  }
  const std::string unit = boost::algorithm::trim_copy(std::string(rest, end));
  if (unit.empty()) return {{value, {"1", 1, 0}}, {}};
  const AnyUnit any = read_any_unit(unit);
  const bool whole = std::all_of(any.powers.begin(), any.powers.end(),
                                 [](const auto& each) { return each.second.denominator() == 1; });
  // The reader of quantities checks gaps in numbers and absolute zero.
  if (whole) return {read_quantity(written, si_text(any.powers)), any.powers};
  return {{value, any.unit}, any.powers};
}

}  // namespace wearwell::formula
