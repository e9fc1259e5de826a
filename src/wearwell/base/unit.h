#pragma once

#include <string>
#include <string_view>

namespace wearwell {

/// A unit written by the user, with its conversion to SI: si = offset + scale * value. The program
/// computes in SI; units are converted on input and output. The scale is finite and positive.
/// docs/reference/units.md lists the allowed units.
struct Unit {
  std::string text;   ///< as written, "mm^3/(N m)"; "1" for a plain number
  double scale = 1;   ///< one unit in SI; also converts differences (standard deviations)
  double offset = 0;  ///< SI value of 0 in this unit; not 0 for degrees Celsius
};

inline double to_si(const Unit& unit, double value) {
  return unit.offset + unit.scale * value;
}
inline double from_si(const Unit& unit, double si) {
  return (si - unit.offset) / unit.scale;
}

/// Reads a unit that must have the dimension of the SI unit `si` ("m^3", "N m", "1").
///
/// A count has its own dimension, in `si` "cycle" or "rev". A unit may omit it ("N m" for "N
/// m/cycle") but not add it, and an angle is not a count. If `si` is a rotational speed, "rev/s" or
/// "rad/s", one revolution is 2 pi rad, and 1/min means revolutions; any other 1/time is refused as
/// ambiguous. If `si` is the logarithm of a quantity, "log10(Pa)", the unit is one too:
/// "log10(MPa)" adds 6.
///
/// Throws InputError if `text` is not a unit, has another dimension, or is ambiguous.
Unit read_unit(std::string_view text, std::string_view si);

/// Whether a plain number is a quantity of the dimension of `si`: "1", or a count.
bool may_be_plain(std::string_view si);

/// Whether a unit is only a number: "1", "1e5", "%".
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

/// Reads "NUMBER UNIT", or a number if `may_be_plain(si)`. Throws InputError like `read_unit`, and
/// for a number with a gap ("35 200 cycles") or a temperature below absolute zero.
Quantity read_quantity(std::string_view text, std::string_view si);

/// Refuses a plain number beside a unit of another size, because it may be in that unit: 5 beside
/// "1e5 cycles". Throws InputError with both readings.
void refuse_two_readings(const Quantity& quantity, const Unit& beside);

}  // namespace wearwell
