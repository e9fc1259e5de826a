#pragma once

#include <limits>

namespace wearwell {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double ln10 = 2.30258509299404568402;
inline constexpr double log_two_pi = 1.83787706640934548356;
inline constexpr double half_log_two_pi = 0.91893853320467274178;

}  // namespace wearwell
