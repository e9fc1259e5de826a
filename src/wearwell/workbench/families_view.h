#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace wearwell::workbench {

/// The families of a study of lives side by side: {family, unit, lives, failures, families: [{name, text,
/// log_likelihood, aic, parameters: [{name, value, unit}], paper, ticks: [{at, share}], points: [[life, at]],
/// line: [[life, at]]}]}, least AIC first; a family without a maximum of its likelihood has `problem` in place of
/// what a fit gives. `family`: the one of the study. `text`: the study with this family (study/family_study.h).
/// Throws InputError for a study that is not of positive lives under one condition with one family.
nlohmann::ordered_json families_json(const std::filesystem::path& file, const std::string& text);

}  // namespace wearwell::workbench
