#pragma once

#include <memory>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/parameter.h"

namespace wearwell::formula_model {

/// Where searches start, and how wide parameters without a proper prior are: nobody has said what is
/// plausible of a law that is not known beforehand. From the middle of the priors and points spread
/// over them, the best climb to a mode. Leaves what it finds no better.
void find_starts(const LogDensity& likelihood, std::vector<Parameter>& parameters);

}  // namespace wearwell::formula_model
