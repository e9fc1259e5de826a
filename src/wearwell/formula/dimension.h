#pragma once

#include <compare>
#include <map>
#include <string>
#include <string_view>

#include "wearwell/base/unit.h"
#include "wearwell/base/unit_system.h"

namespace wearwell::formula {

/// A fraction in lowest terms, of small numbers.
class Power {
 public:
  constexpr Power(int whole = 0) : above_(whole) {}
  Power(int numerator, int denominator);
  int numerator() const { return above_; }
  int denominator() const { return below_; }
  bool operator==(const Power& other) const = default;
  /// Some order, not that of size.
  auto operator<=>(const Power& other) const = default;
  Power operator-() const { return {-above_, below_}; }
  friend Power operator+(const Power& a, const Power& b);
  friend Power operator*(const Power& a, const Power& b);

 private:
  int above_ = 0, below_ = 1;
};

/// Powers of the base units (docs/reference/units.md: those of the SI, "cycle" for whatever is counted and
/// "radian"), none of them 0. Unlike those of a written unit they may be fractions: the square root
/// of a length is met on the way to a stress intensity. Empty for a pure number.
using Powers = std::map<std::string, Power>;

Powers powers_of(const wearwell::Dimension& dimension);

Powers product(const Powers& a, const Powers& b);
Powers quotient(const Powers& a, const Powers& b);
Powers raised(const Powers& a, Power exponent);

/// As a person reads it: "N", "m/s^2", "m^3/(N m)", "sqrt(m)"; "a pure number" for none.
std::string description(const Powers& powers);

/// The same as a unit that `read_unit` takes for the SI: "m", "kg.m2.s-3"; "1" for a pure number.
/// Throws InputError where a power is a fraction.
std::string si_text(const Powers& powers);

/// A unit of any dimension.
struct AnyUnit {
  Unit unit;
  Powers powers;
};
struct AnyQuantity {
  Quantity quantity;  ///< quantity.si() is its value inside
  Powers powers;
};

/// Reads a unit whatever it measures, with all that `read_unit` refuses refused: "mm^3/(N m)",
/// "degC" (which has an offset), "1", "cycles"; and with square roots, "MPa sqrt(m)", "MPa m^0.5".
/// Throws InputError.
AnyUnit read_any_unit(std::string_view text);

/// Reads "NUMBER UNIT", or a number alone, which is a pure number. Throws InputError.
AnyQuantity read_any_quantity(std::string_view text);

}  // namespace wearwell::formula
