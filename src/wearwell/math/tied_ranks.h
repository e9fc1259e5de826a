#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace wearwell {

/// The rank of each value in ascending order, from 0. Neighbours in this order that are not more than `tolerance` apart
/// have the same rank, so numbers that are equal but for rounding errors are ordered alike on every processor.
inline std::vector<std::uint32_t> tied_ranks(std::span<const double> values, double tolerance) {
  std::vector<std::uint32_t> order(values.size()), rank(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return values[a] < values[b]; });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const bool above = values[order[i]] - values[order[i - 1]] > tolerance;
    rank[order[i]] = rank[order[i - 1]] + (above ? 1 : 0);
  }
  return rank;
}

}  // namespace wearwell
