#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "wearwell/study/model.h"

namespace wearwell::workbench {

/// What the study of a text says before any data: {priors: [{name, meaning, unit, proper, q05, q50, q95, log,
/// x, y, handles: [{name, at}], specification}], quantities: [{name, unit, q05, q50, q95}], obstacle} (study/prior_view.h). Numbers that are not
/// finite are null. Throws InputError for a text that cannot be read.
nlohmann::ordered_json priors_json(const std::filesystem::path& file, const std::string& text,
                                   Models models);

/// The study with one handle of a prior moved (prior_handles.h). `wish`: {specification, meaning, handle, at} of
/// that prior. {text, values: [{path, value}], prior}: the keys that have other values, and the prior as above.
nlohmann::ordered_json moved_prior_json(const std::string& text, const nlohmann::json& wish);

}  // namespace wearwell::workbench
