#pragma once

#include <string>

namespace wearwell {

/// A lognormal number as people write it: "1 x/ 1.34" has the median 1, and two thirds lie within a
/// factor of 1.34.
struct MedianFactor {
  double median = 1;
  double factor = 1;  ///< at least 1; 1: a known number
};

/// "0.7", or "0.7 x/ 1.5". Throws InputError that begins with `name`, an option or a key.
MedianFactor read_median_factor(const std::string& name, const std::string& text);

}  // namespace wearwell
