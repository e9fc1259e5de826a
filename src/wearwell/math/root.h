#pragma once

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace wearwell {

/// The tolerance of a root search: it ends when the bracket is no wider than the sum of both.
struct Closeness {
  double absolute = 0;
  double relative = 0;  ///< relative to the root
};

/// The zero of an increasing function. The bracket grows outward from `guess`, with steps that
/// begin at `step` > 0 and double, between `lowest` and `highest`; then algorithm 748 of Alefeld,
/// Potra and Shi (1995) closes it. Returns `lowest` if the function is positive there, `highest` if
/// it is negative there, and NaN if it is NaN. Bracketing takes one call per doubling (2100 for the
/// whole range of doubles), closing at most 200.
template <class F>
double solve_increasing(const F& f, double guess, double step, Closeness close,
                        double lowest = -std::numeric_limits<double>::max(),
                        double highest = std::numeric_limits<double>::max()) {
  double a = std::clamp(guess - step, lowest, highest),
         b = std::clamp(guess + step, lowest, highest);
  double at_a = f(a), at_b = f(b);
  for (double width = step; at_a > 0; at_a = f(a)) {
    if (a <= lowest) return lowest;
    b = a;
    at_b = at_a;
    a = std::max(lowest, a - (width *= 2));
  }
  for (double width = step; at_b < 0; at_b = f(b)) {
    if (b >= highest) return highest;
    a = b;
    at_a = at_b;
    b = std::min(highest, b + (width *= 2));
  }
  if (std::isnan(at_a) || std::isnan(at_b)) return std::nan("");
  if (at_a == 0) return a;
  if (at_b == 0) return b;
  std::uintmax_t iterations = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      f, a, b, at_a, at_b,
      [&](double l, double r) {
        return r - l <= close.absolute + close.relative * std::min(std::abs(l), std::abs(r));
      },
      iterations);
  return 0.5 * (left + right);
}

}  // namespace wearwell
