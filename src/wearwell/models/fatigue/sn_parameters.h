#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/parameter.h"
#include "wearwell/input/prior.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_law.h"

namespace wearwell {

/// The unknowns of an S-N study in the order that SnLaw counts them, with the priors of the study or
/// weak ones made of what is known of such curves and of the size of the tested stresses. Throws
/// InputError.
std::vector<Parameter> sn_parameters(const TomlReader& root, const fatigue::SnLaw& law,
                                     const SnData& data);

/// read_prior of a parameter of the driver of lives (SnData::stress_si); where its dimension is wrong the
/// message says where the driver's comes from.
Parameter read_driver_prior(const TomlReader& root, const std::optional<TomlReader>& priors,
                            const ParameterSpec& spec, const std::string& stress_si,
                            const Unit& stress_unit);

/// What each of them is, in words.
std::vector<std::string> sn_meanings(const fatigue::SnLaw& law);

}  // namespace wearwell
