#pragma once

#include <string>

namespace wearwell {

/// A number for a terminal with the given significant digits: "0.7759", "304 400", "7.759 ×
/// 10^-10".
std::string plain_number(double x, int digits = 4);

/// A given number with all digits.
std::string plain_given(double x);

/// "26.6 km", "35.77 × 10^6 cycles" in the unit "1e6 cycles".
std::string plain_quantity(double x, const std::string& unit, int digits = 4);

/// "18 200 to 26 600".
std::string plain_range(double low, double high, int digits = 4);

}  // namespace wearwell
