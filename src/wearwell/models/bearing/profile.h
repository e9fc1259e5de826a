#pragma once

#include <optional>
#include <vector>

namespace wearwell::bearing {

/// A measured surface profile across a worn region, in m: position along the surface, ascending,
/// and height, upward out of the material.
struct Profile {
  std::vector<double> position;
  std::vector<double> height;
};

/// The area removed by wear between two profiles of one region.
struct WornArea {
  double area = 0;          ///< m^2
  double sd = 0;            ///< its standard deviation from the noise of the profiles, m^2
  double half_width = 0;    ///< of its 90 % interval, m^2
  double shift = 0;         ///< shift of the profile after wear along the surface, m; 0 if the
                            ///< flanks have no feature to align by
  double offset = 0;        ///< its shift in height at the middle, m
  double tilt = 0;          ///< its tilt, height over position
  double noise = 0;         ///< standard deviation of the aligned difference on the flanks, m
  double correlation = 1;   ///< of that noise: number of neighbouring points that count as one
  double from = 0, to = 0;  ///< the worn region, between the flanks, m
  /// by how much the inner quarter of the flanks is lower than the rest, in
  double flank_step = 0;
  ///< its standard deviations: large if wear extends into the flanks
};

/// A flank_step above this indicates wear in the flanks.
inline constexpr double suspicious_step = 4;

/// The second way to a wear rate of Ligterink and de Gee (1996). `flank` is the unworn length at
/// either end of the common part (default: a fifth of that part). The profile after wear is aligned
/// to the one before by the flanks: height and tilt by least squares, the shift along the surface
/// (up to a quarter of a flank) by the least misfit, and only if that is significantly better than
/// no shift. The difference h between the flanks is integrated (trapezoids), on a surface of
/// `curvature` 1/R as h (1 + h/2R): positive for a bore, negative for a shaft, in 1/m.
///
/// Uncertainty: the noise of the difference on the flanks, assumed to continue between them, in the
/// integral and in the height, tilt and shift that it depends on. Neighbouring points are correlated
/// (stylus, filter, roughness); the correlation is estimated (flank_noise.h) and is itself
/// uncertain, so the interval is wider than 1.645 standard deviations. Waves longer than a flank
/// are not visible there and not included.
///
/// Throws InputError: positions that do not ascend, too short a common part, flanks of fewer than
/// 20 points or together fewer than 6 independent ones, or too long.
WornArea worn_area(const Profile& before, const Profile& after, std::optional<double> flank = {},
                   double curvature = 0);

}  // namespace wearwell::bearing
