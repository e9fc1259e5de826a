#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// A unit that the user wrote, and its way to SI: si = offset + scale * value. Inside the program
/// all is SI; units are read at the door and used again at the exit.
struct Unit {
  std::string text;   ///< as written, "mm^3/(N m)"; "1" for a plain number
  double scale = 1;   ///< one unit in SI; converts differences (standard deviations) too
  double offset = 0;  ///< SI value of zero units; not 0 for degrees Celsius
};

inline double to_si(const Unit& unit, double value) {
  return unit.offset + unit.scale * value;
}
inline double from_si(const Unit& unit, double si) {
  return (si - unit.offset) / unit.scale;
}

/// Reads a unit that must have the dimension of the SI unit `si` ("m^3", "N m", "1"). Where `si` is
/// the logarithm of a quantity, "log10(Pa)", so is the unit: "log10(MPa)" is that plus 6.
/// Throws InputError when `text` is no unit or has another dimension.
Unit read_unit(std::string_view text, std::string_view si);

/// Whether a unit is the logarithm of a quantity, whose differences are plain numbers.
inline bool is_logarithm(std::string_view unit) {
  return unit.starts_with("log10(") && unit.ends_with(")");
}

/// A number with its unit, "5.966 N m".
struct Quantity {
  double value = 0;  ///< in `unit`, as written
  Unit unit;
  double si() const { return to_si(unit, value); }
};

/// Reads "NUMBER UNIT"; a number alone is accepted only where `si` is "1". Throws InputError.
Quantity read_quantity(std::string_view text, std::string_view si);

}  // namespace wearwell
