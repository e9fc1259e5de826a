#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "wearwell/bayes/posterior.h"

namespace wearwell {

/// A posterior whose moments are known, on which every method is tried.
struct KnownPosterior {
  std::string name;
  std::function<Posterior()> make;
  std::vector<double> mean, sd;  ///< of each parameter
  std::vector<double> median;    ///< empty where it is not known
};

inline std::ostream& operator<<(std::ostream& out, const KnownPosterior& known) {
  return out << known.name;
}

/// The list: normal, correlated in 2 and 5 dimensions, banana, bimodal, half-bounded, truncated,
/// Student tail, a regression, and the joint-wear posteriors of An et al. (2011) after 5 data sets (normal) and 6
/// (lognormal), by tests/golden/joint_grid.R.
const std::vector<KnownPosterior>& known_posteriors();

/// The joint-wear posterior of the first `rows` inspections; sigma ~ U(0, upper) mm^3, flat without
/// a bound for infinity; k flat, or N(5.05e-4, 0.74e-4) mm^3/(N m) when `tribometer`. Units mm^3/(N
/// m) and mm^3.
Posterior joint_posterior(bool lognormal, bool tribometer, double upper, std::size_t rows);

/// A parameter with an unbounded flat prior and no unit.
Parameter flat_parameter(const std::string& name, double start, double scale);

}  // namespace wearwell
