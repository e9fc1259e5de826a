#pragma once

#include <algorithm>
#include <cmath>

#include "wearwell/math/root.h"

namespace wearwell::families {

/// Where the logarithm of the distribution function (`below`) or of survival is `log_tail`, by
/// Newton's method in log y. Both are concave in log y if the density of log y is log-concave: it
/// then converges from any side. NaN if it does not within a few steps.
template <class F>
double tail_root(bool below, double log_tail, const double* s, double start) {
  constexpr int most_steps = 40;
  double x = std::log(start);
  for (int i = 0; i < most_steps; ++i) {
    const double y = std::exp(x);
    const double tail = below ? F::log_cdf(y, s) : F::log_survival(y, s);
    const double slope = std::exp(F::log_density(y, s) + x - tail);
    const double step = (below ? log_tail - tail : tail - log_tail) / slope;
    if (!std::isfinite(step)) return std::nan("");
    x += step;
    if (!(std::abs(x) < 700)) return std::nan("");
    // What is left is about the square of the step times its relative change of slope.
    if (step * step * std::max(1.0, slope) < 1e-13) return std::exp(x);
  }
  return std::nan("");
}

/// The quantile of a positive family without a formula, by a search from `start` > 0.
template <class F>
double positive_quantile(double p, const double* s, double start) {
  const bool below = p < 0.5;
  const double y = tail_root<F>(below, below ? std::log(p) : std::log1p(-p), s, start);
  if (y > 0) return y;
  const double log_y =
      solve_increasing([&](double x) { return std::exp(F::log_cdf(std::exp(x), s)) - p; },
                       std::log(start), 0.5, {.absolute = 1e-12}, -700, 700);
  return std::exp(log_y);
}

/// Where P(Y > y) = q.
template <class F>
double positive_upper_quantile(double q, const double* s, double start) {
  const bool below = q > 0.5;
  const double y = tail_root<F>(below, below ? std::log1p(-q) : std::log(q), s, start);
  if (y > 0) return y;
  const double log_y =
      solve_increasing([&](double x) { return q - std::exp(F::log_survival(std::exp(x), s)); },
                       std::log(start), 0.5, {.absolute = 1e-12}, -700, 700);
  return std::exp(log_y);
}

}  // namespace wearwell::families
