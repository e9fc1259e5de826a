#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "wearwell/models/clutch/operating_point.h"

namespace wearwell::clutch {

/// The plan. Arrays are by input, in the order of `inputs`.
struct DesignRequest {
  std::array<std::vector<double>, 4> levels;  ///< at least two each, ascending
  int inside = 20;                            ///< points between the levels, for validation
  int outside = 20;                           ///< points beyond the levels, to fit
  std::array<double, 4> lowest, highest;      ///< feasible ranges, at least those of the levels
  double most_energy = 0;                     ///< feasible energy of one closing, J; 0: any
  std::array<double, 4> step;  ///< points other than the factorial's are rounded to this
  std::uint64_t seed = 1;
};

/// Operating points of a campaign (Haramina et al. 2025, section 2.2): the full factorial of the
/// levels; `outside` points that leave the levels' ranges in at least one input but stay feasible;
/// `inside` points within the ranges. The latter two are placed so that the least distance to all
/// other points, in units of the levels' ranges, is as large as possible (maximin: greedy over
/// random candidates, then exchanges until none improves it). Numbered in that order. Throws
/// InputError for invalid levels or ranges.
std::vector<DesignPoint> plan(const DesignRequest& request);

/// Distance of two points in units of the levels' ranges.
double design_distance(const DesignRequest& request, const OperatingPoint& a,
                       const OperatingPoint& b);

}  // namespace wearwell::clutch
