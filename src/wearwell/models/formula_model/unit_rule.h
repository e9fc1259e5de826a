#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace wearwell::formula_model {

/// exp of a whole array, in vectors; `y` may be `x`.
void exp_all(const double* x, double* y, std::size_t n);
/// log likewise.
void log_all(const double* x, double* y, std::size_t n);

// A trapezoidal rule about the mode of a unit's integrand, which judges itself: its error is about the square of what
// every second node of it is off.

/// Between its nodes, in widths at the mode, one after the other until it settles.
inline constexpr double rule_gaps[] = {0.6, 0.3, 0.15};
/// So far below its highest the logarithm of the integrand counts no more.
inline constexpr double rule_fallen = 30;

/// The logarithm of the integral by nodes `width` apart; nothing where every second of them tells another. `nodes` has
/// their `count`; of each `f`, the logarithm of the integrand, of which its share of the integral becomes, and `odd`,
/// whether the rule of every second one leaves it out.
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
