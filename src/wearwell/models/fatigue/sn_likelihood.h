#pragma once

#include <memory>

#include "wearwell/bayes/log_density.h"
#include "wearwell/models/fatigue/life_test.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell::fatigue {

/// The likelihood of an S-N model's parameters for the first `rows` tests: failures by their
/// density per cycle, the rest by the probability of the observation. -infinity if a mean stress
/// reaches the strength. Its pointwise terms are those of one test of each row.
std::shared_ptr<const LogDensity> sn_likelihood(const SnLaw& law, const LifeTests& tests,
                                                std::size_t rows);

}  // namespace wearwell::fatigue
