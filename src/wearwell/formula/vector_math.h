#pragma once

// Exponential and logarithm without branches, so that loops over them vectorize. The
// methods and constants are those of Sun's fdlibm (e_exp.c, e_log.c; errors below one unit in the
// last place). Functions are local to each source, because each source is compiled for its own
// vector width.

#include <bit>
#include <cstdint>
#include <limits>

#include "wearwell/math/constants.h"

namespace wearwell::formula {
namespace {

constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;

// 2^k for a whole number k in -1022 .. 1023.
inline double power_of_two(double k) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(k + (0x1p52 + 1023)) << 52);
}

inline double vector_exp(double x) {
  constexpr double to_integer = 0x1.8p52, log2e = 1.44269504088896338700e+00;
  constexpr double p1 = 1.66666666666666019037e-01, p2 = -2.77777777770155933842e-03,
                   p3 = 6.61375632143793436117e-05, p4 = -1.65339022054652515390e-06,
                   p5 = 4.13813679705723846039e-08;
  double t = x > 710 ? 710 : x;
  t = t < -746 ? -746 : t;
  const double k = (t * log2e + to_integer) - to_integer;
  const double high = t - k * ln2_high, low = k * ln2_low;
  const double r = high - low, z = r * r;
  const double c = r - z * (p1 + z * (p2 + z * (p3 + z * (p4 + z * p5))));
  const double y = 1 - ((low - (r * c) / (2 - c)) - high);
  const double half = (k * 0.5 + to_integer) - to_integer;  // 2^k may overflow, its halves do not
  return y * power_of_two(half) * power_of_two(k - half);
}

inline double vector_log(double x) {
  constexpr double l1 = 6.666666666666735130e-01, l2 = 3.999999999940941908e-01,
                   l3 = 2.857142874366239149e-01, l4 = 2.222219843214978396e-01,
                   l5 = 1.818357216161805012e-01, l6 = 1.531383769920937332e-01,
                   l7 = 1.479819860511658591e-01;
  constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcd, one = 0x3ff0000000000000;
  const bool tiny = x < 0x1p-1022;
  const double scaled = tiny ? x * 0x1p54 : x;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(scaled) + (one - root_half);
  const double biased = std::bit_cast<double>((bits >> 52) | 0x4330000000000000) - 0x1p52;
  const double k = biased - (tiny ? 1023.0 + 54.0 : 1023.0);
  const double f = std::bit_cast<double>((bits & 0x000fffffffffffff) + root_half) - 1;
  const double s = f / (2 + f), z = s * s, w = z * z;
  const double r = z * (l1 + w * (l3 + w * (l5 + w * l7))) + w * (l2 + w * (l4 + w * l6));
  const double half_square = 0.5 * f * f;
  double y = s * (half_square + r) + k * ln2_low - half_square + f + k * ln2_high;
  y = x < infinity ? y : x;  // infinity and NaN pass through
  y = x == 0 ? -infinity : y;
  return x < 0 ? std::numeric_limits<double>::quiet_NaN() : y;
}

}  // namespace
}  // namespace wearwell::formula
