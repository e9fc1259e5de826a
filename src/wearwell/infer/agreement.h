#pragma once

#include <string>
#include <vector>

#include "wearwell/infer/fit.h"

namespace wearwell {

/// The difference between draws and quadrature for one statistic of one parameter.
struct Disagreement {
  std::size_t parameter = 0;
  std::string number;     ///< "median"
  double errors = 0;      ///< Monte Carlo standard errors
  double deviations = 0;  ///< standard deviations of the posterior
};

/// The 5, 50 and 95 % quantiles and the mean (if a variance exists) of each parameter. Requires
/// quadrature (`fit.exact`).
std::vector<Disagreement> distances_from_exact(const Fit& fit);

/// The significant differences: correct draws give any of them with probability `level` (Sidak
/// 1967; correlation within a parameter makes this smaller). A difference far below a standard
/// deviation is ignored for any number of draws.
std::vector<Disagreement> disagreements(const Fit& fit, double level);

/// The probability that correct draws are reported to disagree.
inline constexpr double agreement_level = 1e-4;

}  // namespace wearwell
