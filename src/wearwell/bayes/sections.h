#pragma once

#include <cstddef>
#include <vector>

namespace wearwell {

/// What a distribution is made of: weight that is spread evenly over center +- half_width.
struct SpreadPoint {
  double center, half_width, weight;
};

/// Puts points in order as far as sums over sections need it: each section lies before the next, of about as many, in any
/// order within. Returns where sections end.
std::vector<std::size_t> in_sections(std::vector<SpreadPoint>& points);

/// The same, sorted within too.
std::vector<std::size_t> sorted_sections(std::vector<SpreadPoint>& points);

}  // namespace wearwell
