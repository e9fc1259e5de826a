#pragma once

#include <cmath>

namespace wearwell {

/// Student's t with `df` degrees of freedom; df 1 is the Cauchy law.
struct StudentT {
  double df;  ///< > 0
  double location;
  double scale;  ///< > 0
};

template <class T>
T log_kernel(const StudentT& law, const T& x) {
  using std::log1p;
  const T z = (x - law.location) / law.scale;
  return -0.5 * (law.df + 1) * log1p(z * z / law.df);
}

}  // namespace wearwell
