#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell::workbench {

/// What the study of a text says before any data: {priors: [{name, meaning, unit, proper, q05, q50, q95, log,
/// x, y}], quantities: [{name, unit, q05, q50, q95}], obstacle} (study/prior_view.h). Numbers that are not
/// finite are null. Throws InputError for a text that cannot be read.
nlohmann::ordered_json priors_json(const std::filesystem::path& file, const std::string& text,
                                   Models models);

}  // namespace wearwell::workbench
