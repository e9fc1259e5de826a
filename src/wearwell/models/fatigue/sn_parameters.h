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

/// The unknowns of an S-N study in the order of SnLaw, with the study's priors or weak ones from
/// what is known of such curves and from the size of the tested stresses. Throws InputError.
std::vector<Parameter> sn_parameters(const TomlReader& root, const fatigue::SnLaw& law,
                                     const SnData& data);

/// read_prior for a parameter of the stress quantity (SnData::stress_si); if its dimension is wrong
/// the message names the source of that dimension.
Parameter read_driver_prior(const TomlReader& root, const std::optional<TomlReader>& priors,
                            const ParameterSpec& spec, const std::string& stress_si,
                            const Unit& stress_unit);

/// Descriptions of each of them.
std::vector<std::string> sn_meanings(const fatigue::SnLaw& law);

}  // namespace wearwell
