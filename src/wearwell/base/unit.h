#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// A unit that the user wrote, and its way to SI: si = offset + scale * value. Inside the program
/// all is SI; units are read at the door and used again at the exit. The scale is finite and above
/// 0. docs/reference/units.md says what may be written.
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

/// Reads a unit that must have the dimension of the SI unit `si` ("m^3", "N m", "1").
///
/// What is counted has a dimension of its own, in `si` a "cycle" or a "rev": a unit may leave it
/// out ("N m" for "N m/cycle"), but never bring one in, and an angle is no count. Where `si` is a
/// speed of rotation, "rev/s" or "rad/s", one revolution is 2 pi rad, and 1/min are revolutions;
/// any other 1/time is refused, since it says neither.
/// Where `si` is the logarithm of a quantity, "log10(Pa)", so is the unit: "log10(MPa)" is that
/// plus 6.
///
/// Throws InputError when `text` is no unit, has another dimension, or can be read in two ways.
Unit read_unit(std::string_view text, std::string_view si);

/// Whether a number without any unit is a quantity of the dimension of `si`: "1", or a count.
bool may_be_plain(std::string_view si);

/// Whether a unit is a number and nothing else: "1", "1e5", "%".
bool is_number(const Unit& unit);

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

/// Reads "NUMBER UNIT"; a number alone where `may_be_plain(si)`. Throws InputError as `read_unit`
/// does, and where a number has a gap ("35 200 cycles") or a temperature is below absolute zero.
Quantity read_quantity(std::string_view text, std::string_view si);

/// Refuses a plain number that stands beside a unit of another size, since it may be meant in that:
/// 5 beside "1e5 cycles". Throws InputError with both readings.
void refuse_two_readings(const Quantity& quantity, const Unit& beside);

}  // namespace wearwell
