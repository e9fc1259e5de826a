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
  /// An arbitrary order, not by size.
  auto operator<=>(const Power& other) const = default;
  Power operator-() const { return {-above_, below_}; }
  friend Power operator+(const Power& a, const Power& b);
  friend Power operator*(const Power& a, const Power& b);

 private:
  int above_ = 0, below_ = 1;
};

/// Powers of the base units (docs/reference/units.md: those of the SI, "cycle" for whatever is
/// counted and "radian"), none of them 0. Unlike the powers of a written unit they may be
/// fractions: a stress intensity has the square root of a length. Empty for a pure number.
using Powers = std::map<std::string, Power>;

Powers powers_of(const wearwell::Dimension& dimension);

Powers product(const Powers& a, const Powers& b);
Powers quotient(const Powers& a, const Powers& b);
Powers raised(const Powers& a, Power exponent);

/// The readable form: "N", "m/s^2", "m^3/(N m)", "sqrt(m)"; "a pure number" if empty.
std::string description(const Powers& powers);

/// The same as an SI unit for `read_unit`: "m", "kg.m2.s-3"; "1" for a pure number. Throws
/// InputError if a power is a fraction.
std::string si_text(const Powers& powers);

/// A unit of any dimension.
struct AnyUnit {
  Unit unit;
  Powers powers;
};
struct AnyQuantity {
  Quantity quantity;  ///< quantity.si() is its value in SI
  Powers powers;
};

/// Reads a unit of any dimension with the checks of `read_unit`: "mm^3/(N m)", "degC" (which has an
/// offset), "1", "cycles"; also square roots, "MPa sqrt(m)", "MPa m^0.5". Throws InputError.
AnyUnit read_any_unit(std::string_view text);

/// Reads "NUMBER UNIT", or a pure number. Throws InputError.
AnyQuantity read_any_quantity(std::string_view text);

}  // namespace wearwell::formula
