#pragma once

#include "wearwell/prob/smallest_extreme_value.h"

namespace wearwell::families {

/// The mirror image of the smallest extreme value distribution (Gumbel).
struct LargestExtremeValue : SmallestExtremeValue {
  static constexpr std::string_view name = "largest-extreme-value";
  static constexpr std::string_view title = "largest extreme value";
  static constexpr StandardDistribution standard = StandardDistribution::largest_extreme_value;
  static constexpr Paper paper = {"largest-extreme-value",
                                  StandardDistribution::largest_extreme_value};

  static double mean(const double* s) { return s[0] + s[1] * 0.57721566490153286; }
};

}  // namespace wearwell::families
