#pragma once

#include <string>
#include <vector>

#include "wearwell/infer/fit.h"

namespace wearwell {

/// How far the draws lie from quadrature in one number of one parameter.
struct Disagreement {
  std::size_t parameter = 0;
  std::string number;     ///< "median"
  double errors = 0;      ///< Monte Carlo standard errors
  double deviations = 0;  ///< standard deviations of the posterior
};

/// Quantiles at 5, 50 and 95 % and the mean (where there is a variance) of each parameter. Only where
/// there is quadrature (`fit.exact`).
std::vector<Disagreement> distances_from_exact(const Fit& fit);

/// Of these, what is no chance: right draws show any of them with a probability of `level` (Sidak 1967; numbers of one parameter are
/// correlated, which makes it less). A difference far below a standard deviation is none, however many the draws.
std::vector<Disagreement> disagreements(const Fit& fit, double level);

/// How probable it is that right draws are told to disagree.
inline constexpr double agreement_level = 1e-4;

}  // namespace wearwell
