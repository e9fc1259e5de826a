#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell::workbench {

/// The numbers of [predict] that a posterior can be asked about again: failure thresholds, conditions, stresses.
/// [{path, number, unit}]; `unit` is "" for a plain number.
nlohmann::ordered_json varied_predictions(const std::string& study, Models models);

/// The study with other values of such keys, {PATH: VALUE}. They do not enter the posterior. Throws InputError
/// for any other key.
std::string with_predictions(const std::string& study, const nlohmann::json& changes,
                             Models models);

}  // namespace wearwell::workbench
