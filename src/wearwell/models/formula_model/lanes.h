#pragma once

#include <algorithm>
#include <span>

#include "wearwell/math/constants.h"

namespace wearwell::formula_model {

// Sums in four lanes, always in the same order: a single sum would wait for the result of each
// addition.

/// The largest; -infinity if empty.
inline double highest_of(std::span<const double> values) {
  double top[4] = {-infinity, -infinity, -infinity, -infinity};
  std::size_t i = 0;
  for (; i + 4 <= values.size(); i += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) top[lane] = std::max(top[lane], values[i + lane]);
  }
  for (; i < values.size(); ++i) top[0] = std::max(top[0], values[i]);
  return std::max(std::max(top[0], top[1]), std::max(top[2], top[3]));
}

struct Sums {
  double sum = 0, square = 0;  ///< of the numbers, and of their squares
};
inline Sums sums_of(std::span<const double> values) {
  double sum[4] = {}, square[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= values.size(); i += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double each = values[i + lane];
      sum[lane] += each;
      square[lane] += each * each;
    }
  }
  for (; i < values.size(); ++i) {
    sum[0] += values[i];
    square[0] += values[i] * values[i];
  }
  return {(sum[0] + sum[1]) + (sum[2] + sum[3]), (square[0] + square[1]) + (square[2] + square[3])};
}

}  // namespace wearwell::formula_model
