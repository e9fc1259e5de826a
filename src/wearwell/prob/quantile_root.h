#pragma once

#include <cmath>

#include "wearwell/math/root.h"

namespace wearwell::families {

/// The quantile of a positive family without a formula, by a search from `middle` > 0.
template <class F>
double positive_quantile(double p, const double* s, double middle) {
  const double log_y =
      solve_increasing([&](double x) { return std::exp(F::log_cdf(std::exp(x), s)) - p; },
                       std::log(middle), 0.5, {.absolute = 1e-12}, -700, 700);
  return std::exp(log_y);
}

/// Where P(Y > y) = q.
template <class F>
double positive_upper_quantile(double q, const double* s, double middle) {
  const double log_y =
      solve_increasing([&](double x) { return q - std::exp(F::log_survival(std::exp(x), s)); },
                       std::log(middle), 0.5, {.absolute = 1e-12}, -700, 700);
  return std::exp(log_y);
}

}  // namespace wearwell::families
