#pragma once

#include <map>
#include <string>
#include <vector>

#include "wearwell/bayes/log_density.h"
#include "wearwell/bayes/parameter.h"

namespace wearwell::formula_model {

/// Start values of searches, and the width of parameters without a proper prior, since plausible
/// values of a user's formula are not known in advance. From the middle of the priors and points
/// spread over them, the best climb to a mode. Changes nothing if it finds nothing better.
void find_starts(const LogDensity& likelihood, std::vector<Parameter>& parameters);

/// Starts at the values known by name, SI, without a search.
void start_at(const std::map<std::string, double>& known, std::vector<Parameter>& parameters);

}  // namespace wearwell::formula_model
