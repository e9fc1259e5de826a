#pragma once

#include "wearwell/models/fatigue/life_test.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// Start values of searches: least squares of log10 life on log10 stress through all tests as if
/// they had failed, with the strength at `strength` [Pa] and gamma at 1/2.
struct SnGuess {
  double log10_a = 0;  ///< a in Pa
  double b = -0.1;
  double sigma = 0;  ///< of log10 life; in cycles for the normal family
};
SnGuess guess(const SnLaw& law, const LifeTests& tests, double strength);

}  // namespace wearwell::fatigue
