#pragma once

#include <cmath>

namespace wearwell {

/// x to 30 of its 53 bits, for comparisons that choose or order: numbers that differ by rounding
/// errors alone are equal, so the choice is the same on every processor.
inline double rounded(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, 30)), exponent - 30);
}

}  // namespace wearwell
