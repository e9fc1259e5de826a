#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace wearwell::formula_model {

/// Node i of n on (-1, 1), ascending.
inline double chebyshev_node(std::size_t i, std::size_t n) {
  return -std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
}

/// Coefficients of T_0, T_1, ... of values at the nodes, which are `stride` apart.
inline std::vector<double> chebyshev_series(const double* values, std::size_t n,
                                            std::size_t stride) {
  std::vector<double> c(n);
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle =
          std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
      sum += values[i * stride] * std::cos(static_cast<double>(k) * (std::numbers::pi - angle));
    }
    c[k] = (k == 0 ? 1 : 2) * sum / static_cast<double>(n);
  }
  return c;
}

/// T_k(t), and their derivatives.
inline void chebyshev_polynomials(double t, std::span<double> value, std::span<double> slope) {
  for (std::size_t k = 0; k < value.size(); ++k) {
    value[k] = k == 0 ? 1 : k == 1 ? t : 2 * t * value[k - 1] - value[k - 2];
    slope[k] = k == 0 ? 0 : k == 1 ? 1 : 2 * value[k - 1] + 2 * t * slope[k - 1] - slope[k - 2];
  }
}

/// A series with the polynomials `of`, or with their derivatives.
inline double chebyshev_sum(const std::vector<double>& c, const std::vector<double>& of) {
  double sum = 0;
  for (std::size_t k = 0; k < c.size(); ++k) sum += c[k] * of[k];
  return sum;
}

}  // namespace wearwell::formula_model
