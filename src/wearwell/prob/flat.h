#pragma once

namespace wearwell {

/// No knowledge: constant. Improper unless both ends are bounded, and then only a cut.
struct Flat {};

/// Knowledge that the quantity lies between two bounds, and no more. The bounds are those of the
/// Law.
struct Uniform {};

template <class T>
T log_kernel(const Flat&, const T&) {
  return T(0);
}

template <class T>
T log_kernel(const Uniform&, const T&) {
  return T(0);
}

}  // namespace wearwell
