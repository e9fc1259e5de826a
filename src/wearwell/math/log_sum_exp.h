#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace wearwell {

/// log(sum(exp(values))) without overflow; of at least one value.
inline double log_sum_exp(std::span<const double> values) {
  const double highest = *std::max_element(values.begin(), values.end());
  if (!std::isfinite(highest)) return highest;
  double sum = 0;
  for (const double value : values) sum += std::exp(value - highest);
  return highest + std::log(sum);
}

/// The same sum, value by value: relative to the largest so far.
class RunningLogSum {
 public:
  void add(double value) {
    if (value == -INFINITY) return;
    if (value > top_) {
      sum_ = sum_ * std::exp(top_ - value) + 1;
      top_ = value;
    } else {
      sum_ += std::exp(value - top_);
    }
  }
  void add(const RunningLogSum& other) {
    if (other.sum_ > 0) add(other.value());
  }
  double value() const { return top_ + std::log(sum_); }  ///< minus infinity without values

 private:
  double top_ = -INFINITY, sum_ = 0;
};

}  // namespace wearwell
