#pragma once

#include <cmath>

namespace wearwell {

/// Jeffreys' law for a scale: density proportional to 1/x on x > 0. Improper unless bounded away
/// from 0 and infinity.
struct Jeffreys {};

template <class T>
T log_kernel(const Jeffreys&, const T& x) {
  using std::log;
  return -log(x);
}

}  // namespace wearwell
