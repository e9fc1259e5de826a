#pragma once

#include <cstddef>
#include <cstdint>

namespace wearwell::formula {

/// The sums of x over the rows of each path up to its own; `starts` is 1 where a path begins. `carried`
/// is what the sum is before the first row of a path (null: 0), `repeats` how many rows alike each
/// row stands for (null: one).
inline void running_sum(const double* x, bool uniform, const std::uint8_t* starts, double* sum,
                        std::size_t n, const double* carried = nullptr,
                        const double* repeats = nullptr) {
  double so_far = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (starts[i] != 0) so_far = carried == nullptr ? 0 : carried[i];
    so_far += repeats == nullptr ? x[uniform ? 0 : i] : repeats[i] * x[uniform ? 0 : i];
    sum[i] = so_far;
  }
}

/// Adds what the adjoints of such sums give to x (sets it where `first`): every x is part of the sums
/// from its row to the end of its path.
inline void running_sum_reverse(const double* adjoint, bool uniform, const std::uint8_t* starts,
                                double* to, std::size_t n, bool first) {
  double behind = 0;
  for (std::size_t i = n; i-- > 0;) {
    behind += adjoint[i];
    if (uniform)
      *to += behind;
    else if (first)
      to[i] = behind;
    else
      to[i] += behind;
    if (starts[i] != 0) behind = 0;
  }
}

}  // namespace wearwell::formula
