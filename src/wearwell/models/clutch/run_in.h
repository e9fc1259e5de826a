#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstdint>
#include <vector>

#include "wearwell/models/clutch/wear_law.h"
#include "wearwell/models/clutch/wear_points.h"

namespace wearwell::clutch {

/// A plate's wear rate relative to that of all.
struct PlateFactor {
  int plate = 0;
  double log_factor = 0;  ///< fitted, their sum is 0
  double standard_error = 0;
  double shrunk = 0;     ///< its posterior expectation, with factors that scatter about 0
  double shrunk_sd = 0;  ///< and its standard deviation

  double factor() const { return std::exp(shrunk); }
};

/// A constant of run-in as reported.
struct RunInConstant {
  const char* name;
  const char* unit;
  double si;  ///< one unit
};
inline constexpr std::array<RunInConstant, 5> run_in_constants = {{{"w0", "mm^3/MJ", mm3_per_MJ},
                                                                   {"w1", "mm^3/MJ", mm3_per_MJ},
                                                                   {"w2", "mm^3/MJ", mm3_per_MJ},
                                                                   {"eps1", "MJ", MJ},
                                                                   {"eps2", "MJ", MJ}}};

struct RunInFit {
  static constexpr int size = run_in_constants.size();
  /// w0, w1, w2 [m^3/J], eps1, eps2 [J]; eps1 > eps2.
  Eigen::Matrix<double, size, 1> parameters;
  /// By linearization at the fit. Errors of eps1 and eps2 are nearly normal on the logarithm only,
  /// where their standard error is the relative one.
  Eigen::Matrix<double, size, size> covariance;
  RunIn run_in;
  /// Covariance of slow, fast, slow_energy, fast_energy of `run_in`.
  Eigen::Matrix4d run_in_covariance;
  double cycle_sd = 0;  ///< scatter of one cycle's wear rate, m^3/J
  std::vector<PlateFactor> plates;
  /// Standard deviation of a new plate's log factor about the mean of these plates'.
  double plate_sd = 0;
  std::size_t blocks = 0;
  int starts = 0;    ///< number of starts
  int agreeing = 0;  ///< number that reached the best sum of squares
  bool converged = false;
  double residual_sum = 0;  ///< weighted residual sum of squares over the degrees of freedom
};

/// Fits w = f (w0 + w1 exp(-Ec/eps1) + w2 exp(-Ec/eps2)), averaged over each block's energy, to the
/// run-in and run-out blocks of all plates together, where f is the plate's factor with a geometric
/// mean of 1 (Haramina et al. 2025, section 3.2). w0, w1, w2 >= 0 enter linearly and are eliminated
/// (variable projection with Kaufman's Jacobian); the energies and factors are found by
/// Levenberg-Marquardt from several starts. A block's variance is cycle_sd^2/cycles plus the
/// balance's. If factors are as uncertain as they scatter, the fitted values must not be used:
/// `shrunk` is their expectation under N(0, plate_sd^2), with plate_sd integrated out under a flat
/// prior (fewer than three plates: no shrinking, and plate_sd is 0). Throws InputError if there are
/// fewer blocks than unknowns.
RunInFit fit_run_in(const std::vector<WornBlock>& blocks);

/// Parametric bootstrap: `count` fits to blocks simulated from `fit`, which was fitted to `blocks`.
/// Repetition b owns random stream b of the seed.
std::vector<RunIn> repeat_run_in(const std::vector<WornBlock>& blocks, const RunInFit& fit,
                                 int count, std::uint64_t seed);

}  // namespace wearwell::clutch
