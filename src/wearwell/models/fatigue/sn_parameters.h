#pragma once

#include <string>
#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell {

/// The unknowns of an S-N study in the order that SnLaw counts them, with the priors of the study or
/// weak ones made of what is known of such curves and of the size of the tested stresses. Throws
/// InputError.
std::vector<Parameter> sn_parameters(const TomlReader& root, const fatigue::SnLaw& law,
                                     const SnData& data);

/// What each of them is, in words.
std::vector<std::string> sn_meanings(const fatigue::SnLaw& law);

}  // namespace wearwell
