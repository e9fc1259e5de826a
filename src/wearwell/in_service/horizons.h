#pragma once

#include <string>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/prognosis/replacement.h"

namespace wearwell::in_service {

/// Horizons, "500 h", as SI, ascending, each once. Throws InputError that begins with "--horizon".
std::vector<double> read_horizons(const std::vector<std::string>& texts, const Unit& axis);
/// A tenth, a quarter and a half of the median life, in round numbers of the axis. Throws InputError
/// if half of the units never fail.
std::vector<double> usual_horizons(const prognosis::PopulationLives& lives, const Unit& axis);

}  // namespace wearwell::in_service
