#pragma once

#include <rapidcheck.h>

#include <cmath>

namespace wearwell {

/// RapidCheck: a number between two positive ones, even in the logarithm, whatever the test's size.
inline rc::Gen<double> between(double lower, double upper) {
  constexpr int steps = 1 << 30;
  return rc::gen::map(
      rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, steps + 1)),
      [=](int i) { return lower * std::pow(upper / lower, static_cast<double>(i) / steps); });
}

}  // namespace wearwell
