#pragma once

#include <cmath>

namespace wearwell {

// Of the standard normal law, apart from the library's own.
inline double density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI);
}
inline double below(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

}  // namespace wearwell
