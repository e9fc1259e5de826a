#pragma once

#include <string>

namespace wearwell {

/// The medium of a number. A page has superscripts, "7.759 × 10⁻⁴"; a terminal may lack them and
/// gets "7.759 × 10^-4". Data files have plain numbers.
enum class Script { page, terminal };

/// An estimated number with the given significant digits: "0.7759", "21 600", "7.759 × 10⁻⁴". Its
/// spaces do not break. Not finite: "–" on a page; "-" (NaN), "inf" and "-inf" on a terminal.
std::string shown_number(double x, int digits, Script script);

/// A given number with all digits: "20 585", "10⁸".
std::string given_text(double x, Script script);

/// The significant digits to show for this relative error, 2 to `most`: the error is less than one
/// unit of the last digit.
int digits_within(double relative_error, int most = 4);

/// With the given number of decimals: "3 673.0".
std::string fixed_text(double x, int decimals, Script script);

/// Two numbers with one power of ten: "6.299 to 9.220 × 10⁻⁴". Each has its own where they lie more
/// than a decade apart and the upper end needs one: "1.640 × 10⁷ to 3.580 × 10¹²".
std::string range_text(double low, double high, int digits, Script script);

/// The unit after a number: "mm³/(N m)" for "mm^3/(N m)", "× 10⁵ cycles" for "1e5 cycles"; without
/// breaks, empty for "1".
std::string unit_description(const std::string& unit, Script script);

/// Powers raised: "5 mm³" of "5 mm^3".
std::string powers_raised(const std::string& text);

/// Formats numbers in a sentence of the program: "1e+06" becomes "1 000 000" and "9e-06" becomes "9
/// × 10⁻⁶".
std::string powers_text(const std::string& text, Script script);

/// The same for text without user-defined names ("survival to 500000 cycles"); also groups
/// thousands.
std::string numbers_text(const std::string& text, Script script);

}  // namespace wearwell
