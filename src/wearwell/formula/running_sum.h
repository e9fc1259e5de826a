#pragma once

#include <cstddef>
#include <cstdint>

namespace wearwell::formula {

/// The cumulative sums of x along each path; `starts` is 1 at the beginning of a path. `carried` is
/// the sum before the first row of a path (null: 0), `repeats` the number of equal rows that each
/// row represents (null: 1).
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

/// Adds the contributions of the sums' adjoints to those of x (assigns if `first`): every x is part
/// of the sums from its row to the end of its path.
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
