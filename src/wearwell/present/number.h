#pragma once

#include <string>

namespace wearwell {

/// Where a number is read. A page has raised digits, "7.759 × 10⁻⁴"; a terminal may lack them and
/// has "7.759 × 10^-4". Files for programs hold plain numbers and use none of this.
enum class Script { page, terminal };

/// An estimated number, to so many significant digits: "0.7759", "21 600", "7.759 × 10⁻⁴". Blanks
/// in it do not break. Not finite: "–" on a page; "-" (NaN), "inf" and "-inf" on a terminal.
std::string shown_number(double x, int digits, Script script);

/// A number that was given, not estimated: all its digits, "20 585", "10⁸".
std::string given_text(double x, Script script);

/// How many significant digits a number with this relative error has to show, 2 to `most`: the error is less than one of the last.
int digits_within(double relative_error, int most = 4);

/// With so many decimals: "3 673.0".
std::string fixed_text(double x, int decimals, Script script);

/// Two numbers with one power of ten: "6.299 to 9.220 × 10⁻⁴".
std::string range_text(double low, double high, int digits, Script script);

/// What stands behind a number: "mm³/(N m)" of "mm^3/(N m)", "× 10⁵ cycles" of "1e5 cycles"; in one
/// piece, empty of "1".
std::string unit_description(const std::string& unit, Script script);

/// Powers raised: "5 mm³" of "5 mm^3".
std::string powers_raised(const std::string& text);

/// A sentence of the program in which "1e+06" becomes "1 000 000" and "9e-06" "9 × 10⁻⁶".
std::string powers_text(const std::string& text, Script script);

/// The same of words without names of a user's in them ("survival to 500000 cycles"): thousands
/// apart, too.
std::string numbers_text(const std::string& text, Script script);

}  // namespace wearwell
