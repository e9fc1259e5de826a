#pragma once

#include <cmath>

#include "wearwell/math/root.h"

namespace wearwell::families {

/// The quantile of a family above 0 without a formula for it, looked for from `middle` > 0 on.
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
