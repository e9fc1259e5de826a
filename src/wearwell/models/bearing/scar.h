#pragma once

namespace wearwell::bearing {

/// The scar of a stationary contact in the bushing, lengths in journal radii.
struct Scar {
  double width = 0;         ///< b/r = 2 sin(alpha)
  double centre_angle = 0;  ///< 2 alpha, seen from the journal's center
};

/// For sigma > 0 and 0 <= delta < 2.
Scar scar(double sigma, double delta);

/// The delta at which the scar is as wide as the journal (alpha = pi/2). A deeper journal cuts a
/// slot with straight sides, whose corners the lune does not include.
double widest_depth(double sigma);

/// A depth that was derived from the width of the scar.
struct ScarDepth {
  double delta = 0;
  double amplification = 0;    ///< d ln(delta) / d ln(width): 2 for a narrow scar, and increasing
  double clearance_power = 0;  ///< d ln(delta) / d ln(sigma) at constant width
};

/// From width = b/r, 0 < b/r < 2: the difference of the two sagittas over the chord. Throws
/// InputError for another width.
ScarDepth depth_from_scar(double sigma, double width);

}  // namespace wearwell::bearing
