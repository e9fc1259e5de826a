#pragma once

#include <vector>

namespace wearwell::joint {

/// Quadrature of the force over one cycle.
enum class WorkRule {
  rectangle,  ///< sum of F_i ds_i, as An et al. (2011, eq. 3)
  trapezoid,  ///< sum of (F_{i-1} + F_i)/2 ds_i; the first force follows the last, since a cycle is
              ///< closed. A profile whose last row repeats its first has a first increment of 0
};

/// Friction work of one cycle [J] from the force [N] and the slip increment [m] that ends at each
/// sample. Throws InputError if it is not positive.
double work_per_cycle(const std::vector<double>& force, const std::vector<double>& slip_increment,
                      WorkRule rule);

/// The pin in its bushing. Radii and length in m; 0 < pin_radius < bushing_radius.
struct PinGeometry {
  double pin_radius;
  double bushing_radius;
  double length;
};

struct WornVolume {
  std::vector<double> cycles;  ///< each number of cycles once, in the order of its first row
  std::vector<double> volume;  ///< m^3
};

/// Worn volume from the position (dx, dy) [m] of the pin's center in the unworn bushing: the pin's
/// area outside the bushing, averaged over all rows of the same number of cycles (over angles),
/// times the length (An et al. 2011, section 3).
WornVolume worn_volume(const PinGeometry& geometry, const std::vector<double>& cycles,
                       const std::vector<double>& dx, const std::vector<double>& dy);

}  // namespace wearwell::joint
