#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace wearwell::formula_model {

/// exp of a whole array, in vectors; `y` may be `x`.
void exp_all(const double* x, double* y, std::size_t n);
/// The log likewise.
void log_all(const double* x, double* y, std::size_t n);

// A trapezoidal rule around the mode of a unit's integrand with an embedded error estimate: its
// error is about the square of the difference to every second node.

/// Distances of its nodes, in widths at the mode, tried in turn until it converges.
inline constexpr double rule_gaps[] = {0.6, 0.3, 0.15};
/// An integrand this far below its maximum (in logarithms) is negligible.
inline constexpr double rule_fallen = 30;

/// The logarithm of the integral by nodes `width` apart; empty if every second node gives another
/// value. `nodes` has their `count`; for each `f`, the logarithm of the integrand, which becomes
/// its weight in the integral, and `odd`, whether the rule of every second node skips it.
template <class Nodes>
std::optional<double> settled(Nodes& nodes, double width) {
  constexpr double most_of_half = 3e-5;
  if (nodes.count == 0) return {};
  const double highest = *std::max_element(nodes.f.data(), nodes.f.data() + nodes.count);
  for (std::size_t i = 0; i < nodes.count; ++i) nodes.f[i] -= highest;
  exp_all(nodes.f.data(), nodes.f.data(), nodes.count);
  double sums[2] = {};
  for (std::size_t i = 0; i < nodes.count; ++i) sums[nodes.odd[i]] += nodes.f[i];
  const double sum = sums[0] + sums[1];
  if (!(std::abs(sums[0] - sums[1]) < most_of_half * sum)) return {};
  for (std::size_t i = 0; i < nodes.count; ++i) nodes.f[i] /= sum;
  return highest + std::log(sum * width);
}

}  // namespace wearwell::formula_model
