#pragma once

#include <optional>
#include <vector>

namespace wearwell::bearing {

/// A measured surface profile across a worn place, in m: position along the surface, ascending, and
/// height, upward out of the material.
struct Profile {
  std::vector<double> position;
  std::vector<double> height;
};

/// The area that wear has removed between two profiles of one place.
struct WornArea {
  double area = 0;        ///< m^2
  double sd = 0;          ///< its standard deviation from the noise of the profiles, m^2
  double half_width = 0;  ///< of its interval of 90 %, m^2
  double shift = 0;   ///< by which the profile after was moved along the surface, m; 0 where the
                      ///< flanks have no feature to align by
  double offset = 0;  ///< by which it was raised in the middle, m
  double tilt = 0;    ///< by which it was turned, height over position
  double noise = 0;   ///< standard deviation of the aligned difference on the flanks, m
  double correlation = 1;   ///< of that noise: as many neighbouring points count as one
  double from = 0, to = 0;  ///< the worn place, between the flanks, m
  double flank_step = 0;    ///< how much lower the inner quarter of the flanks is than the rest, in
                            ///< its standard deviations: large when wear reaches into the flanks
};

/// A flank_step above this says that wear reaches into the flanks.
inline constexpr double suspicious_step = 4;

/// The second way to a wear rate of Ligterink and de Gee (1996). `flank` is the length at either
/// end of the common part that is not worn (default: a fifth of that part). The profile after is
/// aligned to the one before by the flanks: height and tilt by least squares, the shift along the
/// surface (up to a quarter of a flank) by the least misfit, and only where that is significantly
/// better than none. The difference h between the flanks is integrated (trapezoids), on a surface
/// of `curvature` 1/R as h (1 + h/2R): positive for a bore, negative for a shaft, in 1/m.
///
/// Uncertainty: the noise of the difference on the flanks, taken to go on between them, in the
/// integral itself and in height, tilt and shift that it rests on. Neighbouring points are
/// correlated (stylus, filter, roughness), by how much is estimated (flank_noise.h) and is itself
/// uncertain: the interval is wider than 1.645 standard deviations. Waves longer than a flank
/// cannot be seen there and are not in it.
///
/// Throws InputError: positions that do not ascend, too short a common part, flanks of fewer than
/// 20 points or together fewer than 6 independent ones, or too long.
WornArea worn_area(const Profile& before, const Profile& after, std::optional<double> flank = {},
                   double curvature = 0);

}  // namespace wearwell::bearing
