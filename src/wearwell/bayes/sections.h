#pragma once

#include <cstddef>
#include <vector>

namespace wearwell {

/// A component of a distribution: weight spread evenly over center +- half_width.
struct SpreadPoint {
  double center, half_width, weight;
};

/// Partitions points into ordered sections of similar size; the order within a section is
/// arbitrary. Returns the ends of the sections.
std::vector<std::size_t> in_sections(std::vector<SpreadPoint>& points);

/// The same, with sorted sections.
std::vector<std::size_t> sorted_sections(std::vector<SpreadPoint>& points);

}  // namespace wearwell
